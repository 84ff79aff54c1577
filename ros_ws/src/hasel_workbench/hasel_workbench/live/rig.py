# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The rig as the page knows it: nobody, or the nodes that are heard; a simulator and a command line for it."""

import os
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

from hasel_recording import HASEL_PAIR, Recording
from hasel_sysid.answer.next_run import Manoeuvre
from hasel_sysid.errors import SysidError

from hasel_workbench.jobs import Progress
from hasel_workbench.live.stream import LiveStream

if TYPE_CHECKING:
    from hasel_workbench.live.link import RigLink

_SILENT_S, _LOOK_S, _START_S = 2.0, 0.05, 300.0
_MISSING = {
    "measured": "No camera is heard: start the tracker.",
    "simulated": "No simulator is heard: start one below.",
}
_MODES = ("STANDBY", "ARMED", "ACTIVE", "FAULT")


class RunningRig:
    """link: to the nodes, where ROS 2 is there. Nothing here arms."""

    def __init__(self) -> None:
        self.stream = LiveStream()
        self.link: RigLink | None = None
        self._own: OwnSimulator | None = None

    @property
    def is_there(self) -> bool:
        """Whether a driver has said something in the last seconds."""
        return self._hears("voltage")

    @property
    def has_simulator(self) -> bool:
        """Whether there is a simulator that can take a model."""
        return self.link is not None and self.link.has_simulator

    def connect(self, namespace: str, domain: int | None = None) -> str:
        """Join the graph in a thread of its own; returns why not, empty where it was done. domain: None: the user's."""
        try:
            from hasel_workbench.live.link import RigLink
        except ImportError as error:
            return f"no live mode: {error}"
        self.link = RigLink(self.stream, namespace, domain)
        self._own = OwnSimulator(namespace, domain)
        return ""

    def close(self) -> None:
        """Leave the graph, and end the simulator that was started from here."""
        if self._own is not None:
            self._own.close()
        if self.link is not None:
            self.link.close()

    async def stop(self) -> str:
        """Ask the driver's emergency stop; returns what it says, or that nobody answers."""
        if self.link is None:
            return "no rig is connected: use the mushroom switch"
        return await self.link.stop()

    def said(self) -> str:
        """What the supply says of itself, and who is not heard, in a line."""
        if self.link is None or self.link.state is None or not self.is_there:
            return "no rig is heard"
        state = self.link.state
        mode = _MODES[state.mode] if state.mode < len(_MODES) else "unknown"
        missing = (sentence for kind, sentence in _MISSING.items() if not self._hears(kind))
        grounded = "grounded" if state.grounded else "not proven grounded"
        return " ".join(filter(None, (f"{mode}, {grounded}.", state.fault_text, *missing)))

    def run(self, manoeuvre: Manoeuvre, progress: Progress) -> str:
        """Have the driver make a run; returns what it says. Raises SysidError where it refuses or nobody is there."""
        if self.link is None or not self.is_there:
            raise SysidError("no rig is heard; start it, and arm it with the driver's own tools")
        return self.link.run(manoeuvre.goal(), progress)

    def load(self, model: Path, progress: Progress) -> str:
        """Let the running simulator take a model file; where there is none, start one. Raises SysidError.

        Where `progress` raises meanwhile, what was started is ended.
        """
        if self.link is None or self._own is None:
            raise SysidError("this workbench does not listen to a rig; start it without --no-rig")
        if self.link.has_simulator:
            return self.link.load(model)
        self._own.start(model)
        try:
            self._await_simulator(self._own, progress)
        except BaseException:
            self._own.close()
            raise
        return "A simulator of this model was started; it ends with the workbench."

    def recordings(self, folder: Path) -> list[Recording]:
        """The runs heard so far, each in a file of its own. Raises SysidError where there is none.

        While the rig is there, one that is going on is left for later.
        """
        return self.stream.recordings(folder, ended=self.is_there)

    def _hears(self, kind: str) -> bool:
        return self.link is not None and time.monotonic() - self.link.heard_at[kind] < _SILENT_S

    def _await_simulator(self, own: "OwnSimulator", progress: Progress) -> None:
        """Until it offers its services and, where a supply drives it, something was simulated."""
        end, begin = time.monotonic() + _START_S, self.stream.count["simulated"]
        while not self.has_simulator or (self.is_there and self.stream.count["simulated"] == begin):
            progress("the simulator starts", 0.0)
            own.check()
            if time.monotonic() > end:
                raise SysidError(f"no simulator was heard within {_START_S:g} s of its start")
            time.sleep(_LOOK_S)


_PATIENCE_S = 10.0


class OwnSimulator:
    """namespace: of the rig; domain: of ROS, None: the user's. It ends with `close`."""

    def __init__(self, namespace: str, domain: int | None = None) -> None:
        self._namespace, self._domain = namespace, domain
        self._process: subprocess.Popen[bytes] | None = None
        self._log = Path()

    def start(self, model: Path) -> None:
        """Begin to simulate a model file; what the process says is in simulator.log beside it."""
        self.close()
        self._log = model.with_name("simulator.log")
        own = {} if self._domain is None else {"ROS_DOMAIN_ID": str(self._domain)}
        file = model.resolve()
        given = ["-r", f"__ns:={self._namespace}", "-p", f"model:={file}", "-p", f"own_files:={file.parent}"]
        command = [sys.executable, "-m", "hasel_sim.live.start_simulator", "--ros-args", *given]
        env = {**os.environ, "PYTHONUNBUFFERED": "1", **own}
        with self._log.open("w") as output:
            self._process = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT, env=env
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


def goal_line(manoeuvre: Manoeuvre) -> str:
    """`ros2 action send_goal …`; empty where no rig of this kind can make the run."""
    if manoeuvre.load_factor is not None or manoeuvre.channels != HASEL_PAIR:
        return ""
    fields = ", ".join(f"{name}: {_yaml(value)}" for name, value in manoeuvre.goal().items())
    action = "/hasel/run_experiment hasel_interfaces/action/RunExperiment"
    return f'ros2 action send_goal --feedback {action} "{{{fields}}}"'


def _yaml(value: object) -> str:
    quoted = f"'{value}'" if isinstance(value, str) else str(value)
    return f"{value:g}" if isinstance(value, float) else quoted
