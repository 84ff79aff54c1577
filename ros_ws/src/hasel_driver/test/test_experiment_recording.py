# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""No two runs are recorded in one file."""

import pytest
from hasel_driver.nodes.experiment_recording import chosen_path, reserve, reserve_unique
from hasel_driver.protocol.faults import LimitError


def test_names_are_unique_however_fast_they_are_made(tmp_path):
    """Fifty names within a moment are fifty files."""
    assert len({reserve_unique(tmp_path, "3000V_1Hz") for _ in range(50)}) == 50


def test_what_exists_is_refused(tmp_path):
    """A second reservation fails, and a folder is no file."""
    reserve(tmp_path / "run.mcap")
    (tmp_path / "folder.mcap").mkdir()
    for name in ("run.mcap", "folder.mcap"):
        with pytest.raises(LimitError, match="exists already"):
            reserve(tmp_path / name)


@pytest.mark.parametrize("output", ["/", "", "~no-such-user/run"])
def test_no_name_is_no_path(tmp_path, output):
    """One sentence instead of an error of pathlib's."""
    with pytest.raises(LimitError, match=r"output: .* is no file below"):
        chosen_path(tmp_path, output)


@pytest.mark.parametrize("output", ["/etc/run", "../run", "inside/../../run", "link/run"])
def test_nothing_outside_the_folder_is_a_path(tmp_path, output):
    """Whoever sends a goal over the network reaches the folder that was given at the start, and no other."""
    folder = tmp_path / "recordings"
    folder.mkdir()
    (folder / "link").symlink_to(tmp_path)
    with pytest.raises(LimitError, match="is no file below"):
        chosen_path(folder, output)
    assert chosen_path(folder, "inside/run") == folder / "inside" / "run.mcap"
