# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import subprocess
from pathlib import Path

ENVIRONMENT = Path(__file__).resolve().parents[2] / "setup" / "environment.bash"


def in_environment(command: str, times: int = 1) -> list[str]:
    """Return the lines that a command prints in a bare shell that sourced the file."""
    script = f". {ENVIRONMENT}\n" * times + command
    result = subprocess.run(
        ["/bin/bash", "-eu", "-c", script],
        env={"PATH": "/usr/bin:/bin"},
        capture_output=True,
        text=True,
        check=True,
    )
    return result.stdout.splitlines()


def test_messages_and_packages_are_importable():
    """After sourcing, Python finds ROS 2, the built messages and the installed packages."""
    (line,) = in_environment(
        "python -c 'import rclpy, hasel_interfaces.msg, hasel_recording; print(hasel_recording.__file__)'"
    )
    assert line.startswith(str(ENVIRONMENT.parents[1] / "install"))


def test_sourcing_twice_adds_nothing():
    """Search paths hold each folder once however often the file is sourced."""
    variables = '"$PATH" "$AMENT_PREFIX_PATH" "$PYTHONPATH" "$LD_LIBRARY_PATH"'
    assert in_environment(f"printf '%s\\n' {variables}", times=2) == in_environment(
        f"printf '%s\\n' {variables}"
    )
