# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The page's programs run as they stand there."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from hasel_sim.model import load_model

PAGE = Path(__file__).resolve().parents[4] / "docs" / "method/simulator.md"


@pytest.fixture(scope="module")
def programs() -> list[str]:
    """The Python programs in the order of the text."""
    return re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)


def _run(program: str, folder: Path) -> str:
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=folder, env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_first_program_simulates_differentiates_and_saves(programs, tmp_path):
    """At most twenty lines; it prints slopes and a smaller angle with drag, and writes a model that can be read."""
    assert len([line for line in programs[0].splitlines() if line.strip()]) <= 20
    output = _run(programs[0], tmp_path)
    assert "d sin(theta) / d amplitude_5500" in output
    plain, dragged = map(float, re.findall(r"\d\.\d{3}", output.splitlines()[-1]))
    assert 0.2 < dragged < plain
    assert load_model(tmp_path / "dragged.yaml").values["quadratic_drag.coefficient"] == 0.25


def test_the_program_side_by_side_continues_the_first(programs, tmp_path):
    """One largest angle per model."""
    assert len(re.findall(r"^0\.\d{3}$", _run(programs[0] + programs[1], tmp_path), re.MULTILINE)) == 2


def test_the_adjoint_program_continues_the_first(programs, tmp_path):
    """It prints one gradient per step and muscle, and one per outline coefficient."""
    output = _run(programs[0] + programs[3], tmp_path)
    assert "torch.Size([240, 2])" in output
    assert "tensor([" in output


def test_the_program_of_the_muscle_prints_strokes_and_forces(programs, tmp_path):
    """By itself: nothing without voltage, and more at more of it."""
    lifted, held = re.findall(r"\[(.*?)\]", _run(programs[4], tmp_path))
    for numbers in (lifted, held):
        none, some, more = map(float, numbers.split())
        assert none == 0 < some < more


def test_files_that_the_text_links_to_exist():
    """Pictures, pages and examples."""
    links = re.findall(r"\]\(([^)#]+)\)", PAGE.read_text(encoding="utf-8"))
    assert links
    assert all((PAGE.parent / link).exists() for link in links)
