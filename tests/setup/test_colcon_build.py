# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import os
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
INTERFACES = ROOT / "ros_ws" / "src" / "hasel_interfaces"


pytestmark = [pytest.mark.slow, pytest.mark.timeout(1800)]  # a build of the messages


@pytest.fixture(scope="module")
def prefix(tmp_path_factory) -> Path:
    """The messages built by `colcon build`, beside what setup/install_wheels.sh leaves where ROS 2 is sourced."""
    checkout = tmp_path_factory.mktemp("checkout")
    site_packages = checkout / ".venv" / "lib" / f"python{sysconfig.get_python_version()}" / "site-packages"
    site_packages.mkdir(parents=True)
    (site_packages / "only_from_pypi.py").write_text("ANSWER = 42\n")
    (checkout / ".venv" / "sourced-ros").write_text("/opt/ros/jazzy/setup.bash\n")
    command = [sys.executable, "-m", "colcon", "--log-base", "log", "build", "--base-paths", str(INTERFACES)]
    command += [
        "--cmake-args",
        f"-DPython3_EXECUTABLE={sys.executable}",
        f"-DPYTHON_EXECUTABLE={sys.executable}",
    ]
    environment = {**os.environ, "HASEL_VENV": str(checkout / ".venv")}
    subprocess.run(
        [*command, "-DBUILD_TESTING=OFF", "-Wno-dev"],
        env=environment,
        check=True,
        cwd=checkout,
        capture_output=True,
    )
    return checkout / "install"


@pytest.mark.parametrize("setup_file", ["setup.bash", "local_setup.bash", "setup.sh"])
def test_who_sources_the_workspace_finds_the_packages_from_pypi(prefix, setup_file):
    """Python sees the environment that was made beside ROS 2, and the messages."""
    python = (
        f"{sys.executable} -c 'import only_from_pypi, hasel_interfaces.msg; print(only_from_pypi.ANSWER)'"
    )
    bare = {name: os.environ[name] for name in ("PATH", "HOME") if name in os.environ}
    shell = "sh" if setup_file.endswith(".sh") else "bash"
    script = f"cd {prefix} && . ./{setup_file} && {python}"
    found = subprocess.run([shell, "-c", script], env=bare, capture_output=True, text=True, check=False)
    assert found.stdout == "42\n", found.stderr
