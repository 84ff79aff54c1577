# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
from fix_wheel_paths import fix_prefix, fix_text

EXPORT = (
    'INTERFACE_INCLUDE_DIRECTORIES "/opt/python/cp312-cp312/include/python3.12;'
    '/opt/python/cp312-cp312/lib/python3.12/site-packages/numpy/_core/include"\n'
)


def test_both_folders_are_replaced_and_nothing_else():
    """Python's and numpy's include folders of any CPython version become ours."""
    assert (
        fix_text(EXPORT, "/py/include", "/np/include")
        == 'INTERFACE_INCLUDE_DIRECTORIES "/py/include;/np/include"\n'
    )
    old_numpy = EXPORT.replace("_core", "core").replace("12", "10")
    assert "/opt/python" not in fix_text(old_numpy, "/py", "/np")
    assert fix_text('set(A "/opt/ros/jazzy")', "/py", "/np") == 'set(A "/opt/ros/jazzy")'


def test_second_run_changes_nothing(tmp_path):
    """Only files that need it are written, and only once."""
    folder = tmp_path / "share" / "std_msgs" / "cmake"
    folder.mkdir(parents=True)
    (folder / "export.cmake").write_text(EXPORT)
    (folder / "other.cmake").write_text("set(A 1)\n")
    assert fix_prefix(tmp_path, "/py", "/np") == [folder / "export.cmake"]
    assert fix_prefix(tmp_path, "/py", "/np") == []
