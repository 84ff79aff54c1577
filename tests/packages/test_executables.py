# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import os
from importlib.metadata import EntryPoint, distributions
from pathlib import Path

import pytest
from ament_index_python.packages import get_package_prefix

EXECUTABLES = [
    (distribution.name, entry_point)
    for distribution in distributions()
    if distribution.name.startswith("hasel_")
    for entry_point in distribution.entry_points.select(group="console_scripts")
]


@pytest.mark.parametrize(
    ("package", "entry_point"), EXECUTABLES, ids=[f"{package}-{entry.name}" for package, entry in EXECUTABLES]
)
def test_is_where_ros2_run_looks(package: str, entry_point: EntryPoint):
    """Every executable is installed to lib/PACKAGE/ and the function behind it can be imported."""
    path = Path(get_package_prefix(package)) / "lib" / package / entry_point.name
    assert os.access(path, os.X_OK)
    assert callable(entry_point.load())
