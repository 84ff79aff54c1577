# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`--help` and `--version` of every executable answer at once: nothing heavy is imported for them."""

import json
import re
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
HEAVY = (
    "cv2", "dask", "distributed", "jinja2", "matplotlib", "nicegui", "numba", "pandas", "plotly", "pydantic", "rich",
    "scipy", "skimage", "statsmodels", "torch",
)  # fmt: skip
NODES = {
    "hasel_bringup recorder",
    "hasel_bringup virtual_camera",
    "hasel_bringup virtual_rig",
    "hasel_driver.nodes.driver_node",
    "hasel_sim simulator",
    "hasel_sysid sysid",
    "hasel_tracker tracker_node",
}
"""They list parameters that are declared in rclpy's terms."""
EXECUTABLES = sorted(
    f"{setup.parent.name} {name}"
    for setup in (ROOT / "ros_ws" / "src").glob("*/setup.py")
    for name in re.findall(r'"(\w+) = [\w.]+:\w+"', setup.read_text(encoding="utf-8"))
)


def _answers(option: str) -> dict[str, dict]:
    script = Path(__file__).with_name("imports_of_help.py")
    command = [sys.executable, str(script), option, *HEAVY, "rclpy"]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=300)
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def answers() -> dict[str, dict]:
    """What every executable says to --help, its exit code and the heavy modules that are imported by then."""
    return _answers("--help")


@pytest.fixture(scope="module")
def versions() -> dict[str, dict]:
    """The same of --version."""
    return _answers("--version")


def test_all_executables_are_asked(answers):
    """Those that the setup files name are those that are installed."""
    assert EXECUTABLES
    assert sorted(answers) == EXECUTABLES


@pytest.mark.parametrize("name", EXECUTABLES)
def test_help_imports_nothing_heavy(name, answers):
    """Usage under the executable's own name, exit code 0, no heavy library, and no rclpy but for nodes."""
    answer = answers[name]
    assert answer["said"].startswith(f"usage: {name.split()[1]} ")
    assert answer["code"] == 0
    assert set(answer["imported"]) <= ({"rclpy"} if name in NODES else set())


@pytest.mark.parametrize("name", EXECUTABLES)
def test_version_is_that_of_the_package(name, versions):
    """Package and version as its metadata says, exit code 0, and no heavy library; `convert` is of one package."""
    answer = versions[name]
    package = "hasel_recording" if name.endswith(" convert") else name.split()[0]
    assert answer["said"] == f"{package} {version(package)}\n"
    assert answer["code"] == 0
    assert answer["imported"] == []
