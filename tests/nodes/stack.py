"""Starts executables of the workspace as a user does, and stops them."""

import os
import signal
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "setup" / "run_executable.py"


class Stack:
    """Processes in a ROS domain of their own; as a context manager, stops and reaps all of them."""

    def __init__(self, folder: Path, domain: int) -> None:
        self._folder = folder
        self._environment = {
            **os.environ,
            "ROS_DOMAIN_ID": str(domain),
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
            "PYTHONUNBUFFERED": "1",
        }
        self._processes: dict[str, subprocess.Popen] = {}

    def start(self, package: str, executable: str, *arguments: str) -> None:
        """Start one, its output going to a file."""
        with self.output(executable).open("w") as output:
            self._processes[executable] = subprocess.Popen(
                [sys.executable, str(SCRIPT), package, executable, *arguments],
                stdout=output,
                stderr=subprocess.STDOUT,
                env=self._environment,
                start_new_session=True,
            )

    def output(self, executable: str) -> Path:
        """Where an executable's output goes."""
        return self._folder / f"{executable}.log"

    def check(self) -> None:
        """Fail with its output when one has ended by itself."""
        for name, process in self._processes.items():
            if process.poll() is not None:
                raise AssertionError(
                    f"{name} ended with {process.returncode}: {self.output(name).read_text()}"
                )

    def finish(self, executable: str, seconds: float) -> int:
        """Wait for one to end by itself and return its exit code."""
        return self._processes.pop(executable).wait(seconds)

    def stop(self, executable: str) -> int:
        """Interrupt one, as Ctrl-C does, and return its exit code."""
        process = self._processes.pop(executable)
        process.send_signal(signal.SIGINT)
        return process.wait(20)

    def __enter__(self) -> "Stack":
        return self

    def __exit__(self, *_: object) -> None:
        for process in self._processes.values():
            process.kill()
            process.wait(10)
