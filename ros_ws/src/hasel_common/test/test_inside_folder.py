# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What others name stays inside one folder."""

from pathlib import Path

import pytest
from hasel_common.inside_folder import inside_folder


@pytest.fixture
def folder(tmp_path, monkeypatch) -> Path:
    """A folder of the home, with a link in it that leads out and one that does not."""
    monkeypatch.setenv("HOME", str(tmp_path))
    folder = tmp_path / "own"
    folder.mkdir()
    (folder / "out").symlink_to(tmp_path)
    (folder / "in").symlink_to(folder / "deep")
    return folder


def test_a_name_inside_is_a_full_path(folder):
    """From the folder, absolute, from the home and by a link; the file need not be there."""
    file = "deep/run.csv"
    for name in (file, f"{folder}/{file}", f"~/own/{file}", "in/run.csv", f"x/../{file}"):
        assert inside_folder("~/own", name) == inside_folder(folder, name) == folder / file


@pytest.mark.parametrize(
    "name",
    [
        *("", ".", "..", "/", "~", "x/..", "../own", "/etc/run.csv", "../run.csv", "../own2/run.csv"),
        *("deep/../../run.csv", "out/run.csv", "~no-such-user/run.csv", "a\0.csv", "\udc80/../../x"),
    ],
)
def test_any_other_name_is_refused(folder, name):
    """What leads out of the folder, is the folder itself, or can be no path: in one sentence with the name."""
    with pytest.raises(ValueError, match=r"is no file below .*own") as refusal:
        inside_folder(folder, name)
    assert repr(name) in str(refusal.value)
