# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Point the CMake files of the ROS 2 wheels at this virtual environment, not at the machine that built them.

The wheels' CMake exports name the include folders of Python and numpy under `/opt/python/cpXY-cpXY/`.
Run with the virtual environment's own Python; a second run changes nothing.
"""

import re
import sys
import sysconfig
from pathlib import Path

import numpy

BUILDER_NUMPY = re.compile(r"/opt/python/[\w.-]+/lib/python[\d.]+/site-packages/numpy/_?core/include")
BUILDER_PYTHON = re.compile(r"/opt/python/[\w.-]+/include/python[\d.]+")


def fix_text(text: str, python_include: str, numpy_include: str) -> str:
    """Return a CMake file's text with both of the builder's include folders replaced."""
    text = BUILDER_NUMPY.sub(lambda _: numpy_include, text)
    return BUILDER_PYTHON.sub(lambda _: python_include, text)


def fix_prefix(prefix: Path, python_include: str, numpy_include: str) -> list[Path]:
    """Rewrite `prefix/share/*/cmake/*.cmake` where needed and return the files that changed."""
    changed = []
    for path in sorted(prefix.glob("share/*/cmake/*.cmake")):
        text = path.read_text(encoding="utf-8")
        fixed = fix_text(text, python_include, numpy_include)
        if fixed != text:
            path.write_text(fixed, encoding="utf-8")
            changed.append(path)
    return changed


if __name__ == "__main__":
    files = fix_prefix(Path(sys.prefix), sysconfig.get_path("include"), numpy.get_include())
    print(f"include folders corrected in {len(files)} CMake files of the ROS 2 wheels")
