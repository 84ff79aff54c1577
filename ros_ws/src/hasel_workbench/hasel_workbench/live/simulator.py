"""A simulator for a rig that has none: the one of `ros2 run hasel_sim simulator`, as a process of the workbench."""

import os
import subprocess
import sys
from pathlib import Path

from hasel_sysid.errors import SysidError

_PATIENCE_S = 10.0


class OwnSimulator:
    """namespace: of the rig; domain: of ROS, None: the user's. It ends with `close`."""

    def __init__(self, namespace: str, domain: int | None = None) -> None:
        self._namespace, self._domain = namespace, domain
        self._process: subprocess.Popen | None = None
        self._log = Path()

    def start(self, model: Path) -> None:
        """Begin to simulate a model file; what the process says is in simulator.log beside it."""
        self.close()
        self._log = model.with_name("simulator.log")
        own = {} if self._domain is None else {"ROS_DOMAIN_ID": str(self._domain)}
        file = model.resolve()
        given = ("-r", f"__ns:={self._namespace}", "-p", f"model:={file}", "-p", f"own_files:={file.parent}")
        with self._log.open("w") as output:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "hasel_sim.live.start_simulator", "--ros-args", *given],
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                env={**os.environ, "PYTHONUNBUFFERED": "1", **own},
            )

    def check(self) -> None:
        """Raise SysidError with its last words where it has ended by itself."""
        if self._process is not None and self._process.poll() is not None:
            lines = self._log.read_text(errors="replace").split("\n")
            said = next((line for line in reversed(lines) if line.strip()), "it said nothing")
            raise SysidError(f"the simulator that was started has ended: {said} (all of it: {self._log})")

    def close(self) -> None:
        """End it, as Ctrl-C does."""
        process, self._process = self._process, None
        if process is None:
            return
        process.terminate()
        try:
            process.wait(_PATIENCE_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
