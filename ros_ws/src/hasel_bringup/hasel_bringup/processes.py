# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Executables of the workspace as processes, started as `ros2 run` does."""

import os
import signal
import subprocess
from collections.abc import Mapping
from pathlib import Path

from ament_index_python.packages import PackageNotFoundError, get_package_prefix

from hasel_bringup.errors import BringupError

OWN_DOMAIN = 1 + os.getpid() % 100
ALONE = {"ROS_DOMAIN_ID": str(OWN_DOMAIN), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
"""Variables of processes that are by themselves with this one: in a ROS domain that no rig in the house hears."""
_PATIENCE_S = 20.0


def executable(package: str, name: str) -> Path:
    """Where `ros2 run PACKAGE NAME` finds its executable. Raises BringupError when it is not installed."""
    try:
        path = Path(get_package_prefix(package)) / "lib" / package / name
    except (PackageNotFoundError, ValueError):
        path = Path(package) / name
    if not path.is_file():
        raise BringupError(f"{package} {name} is not installed; build the workspace first: make build")
    return path


class Processes:
    """Processes with their output in files of a folder; as a context manager, ends all of them.

    environment: variables in addition to this process's own.
    """

    def __init__(self, folder: Path, environment: Mapping[str, str]) -> None:
        self._folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        self._environment = {**os.environ, "PYTHONUNBUFFERED": "1", **environment}
        self._running: dict[str, subprocess.Popen[bytes]] = {}

    def start(self, package: str, name: str, *arguments: str) -> None:
        """Start an executable."""
        with self.output(name).open("w") as output:
            self._running[name] = subprocess.Popen(
                [executable(package, name), *arguments],
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                env=self._environment,
                start_new_session=True,
            )

    def output(self, name: str) -> Path:
        """The file with what an executable printed."""
        return self._folder / f"{name}.log"

    def process_id(self, name: str) -> int:
        """Number of a running process."""
        return self._running[name].pid

    def check(self) -> None:
        """Raise BringupError when one has failed."""
        for name, process in self._running.items():
            if process.poll():
                raise BringupError(
                    f"{name} failed with exit code {process.returncode}; see {self.output(name)}"
                )

    def ended(self, name: str) -> bool:
        """Whether one has ended by itself."""
        return self._running[name].poll() is not None

    def finish(self, name: str, seconds: float) -> int:
        """Wait for one to end by itself and return its exit code."""
        return self._running.pop(name).wait(seconds)

    def stop(self, name: str, number: signal.Signals = signal.SIGINT) -> int:
        """End one, as Ctrl-C does if no other signal is given, and return its exit code."""
        process = self._running.pop(name)
        process.send_signal(number)
        try:
            return process.wait(_PATIENCE_S)
        except subprocess.TimeoutExpired:
            process.kill()
            return process.wait()

    def kill(self, name: str) -> None:
        """End one as a crash does."""
        process = self._running.pop(name)
        process.kill()
        process.wait()

    def __enter__(self) -> "Processes":
        return self

    def __exit__(self, *_: object) -> None:
        for name in list(self._running):
            self.stop(name)
