"""The driver on a virtual board, in processes of their own."""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

from hasel_bringup.errors import BringupError

_PATIENCE_S = 15.0


class RigSupply:
    """Starts the board and the driver on its port; as a context manager, ends both.

    namespace: of the driver, such as /hasel.
    """

    def __init__(self, namespace: str) -> None:
        self._namespace = namespace

    def __enter__(self) -> "RigSupply":
        self._folder = tempfile.TemporaryDirectory(prefix="hasel_")
        port = Path(self._folder.name) / "supply"
        self._processes = [self._start("hasel_driver.virtual.virtual_supply", "--link", str(port))]
        try:
            self._wait_for(port)
            self._processes.append(
                self._start(
                    "hasel_driver.nodes.driver_node",
                    "--ros-args",
                    *("-r", f"__ns:={self._namespace}"),
                    *("-p", f"port:={port}"),
                    *("-p", "history_file:=" + str(port.with_name("history.jsonl"))),
                    *("-p", f"state_folder:={port.parent}"),
                )
            )
        except BringupError:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        for process in reversed(self._processes):
            process.terminate()
        for process in self._processes:
            try:
                process.wait(5.0)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        self._folder.cleanup()

    def check(self) -> None:
        """Raise BringupError when one of the two has ended."""
        if any(process.poll() is not None for process in self._processes):
            raise BringupError(
                "the driver or its virtual board has ended; see its message above, or run without them: --body-only"
            )

    @staticmethod
    def _start(module: str, *arguments: str) -> subprocess.Popen:
        return subprocess.Popen(
            [sys.executable, "-m", module, *arguments],
            stdin=subprocess.DEVNULL,
            stdout=None if module.endswith("_node") else subprocess.DEVNULL,
        )

    def _wait_for(self, port: Path) -> None:
        end = time.monotonic() + _PATIENCE_S
        while not port.exists():
            if time.monotonic() > end or self._processes[0].poll() is not None:
                raise BringupError(
                    "the virtual supply did not open its port; run `ros2 run hasel_driver virtual_supply` to see why"
                )
            time.sleep(0.05)
