# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The page's program prints what stands there."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[4]
PAGE = (ROOT / "docs" / "reference/python.md").read_text(encoding="utf-8")


@pytest.mark.timeout(600)
def test_the_program_names_the_drag():
    """The same effects stage by stage, and the same errors but for the last digits."""
    program, printed = re.search(r"```python\n((?:(?!```).)*)```\s+```\n(.*?)```", PAGE, re.DOTALL).groups()
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    number = r"\d\.\d{5}"
    assert re.sub(number, "", done.stdout) == re.sub(number, "", printed)
    expected = [float(value) for value in re.findall(number, printed)]
    assert [float(value) for value in re.findall(number, done.stdout)] == pytest.approx(expected, rel=0.02)
