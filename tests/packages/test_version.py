# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Every package of ours in Python says its version."""

from importlib import import_module
from importlib.metadata import version
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = sorted(path.parent.name for path in (ROOT / "ros_ws" / "src").glob("*/setup.py"))


@pytest.mark.parametrize("package", PACKAGES)
def test_a_package_says_its_version(package):
    """As its metadata does, and has no other attribute that is not there."""
    module = import_module(package)
    assert module.__version__ == version(package)
    assert not hasattr(module, "no_such_thing")
