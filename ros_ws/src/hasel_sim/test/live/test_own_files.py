# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Names of the catalogue, and files of one folder."""

import pytest
from hasel_sim.errors import ModelError
from hasel_sim.live.live_simulator import within


def test_a_file_of_the_folder_is_given_by_its_full_path(tmp_path):
    """Effects and models alike; names of the catalogue stay as they are."""
    assert within("", "quadratic_drag") == "quadratic_drag"
    assert within(str(tmp_path), "mine.py:Mine") == f"{tmp_path.resolve()}/mine.py:Mine"
    assert within(str(tmp_path), f"{tmp_path}/fit/model.yaml") == f"{tmp_path.resolve()}/fit/model.yaml"


@pytest.mark.parametrize("name", ["/etc/evil.py:X", "../evil.py:X", "a/../../evil.py:X", "/etc/model.yaml"])
def test_any_other_file_is_refused(tmp_path, name):
    """By an absolute path, and by one that leads out of the folder."""
    folder = tmp_path / "own"
    folder.mkdir()
    with pytest.raises(ModelError, match="own_files"):
        within(str(folder), name)
    with pytest.raises(ModelError, match="own_files"):
        within("", name)
