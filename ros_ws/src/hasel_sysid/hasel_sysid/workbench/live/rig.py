"""The rig as the page knows it: nobody, or the nodes that are heard."""

import time
from pathlib import Path
from typing import TYPE_CHECKING

from hasel_sysid.errors import SysidError
from hasel_sysid.suggest import Manoeuvre
from hasel_sysid.workbench.evaluate import Progress
from hasel_sysid.workbench.live.stream import LiveStream

if TYPE_CHECKING:
    from hasel_sysid.workbench.live.link import RigLink

_SILENT_S = 2.0
_MODES = ("STANDBY", "ARMED", "ACTIVE", "FAULT")


class Rig:
    """link: to the nodes, where ROS 2 is there. Nothing here arms."""

    def __init__(self) -> None:
        self.stream = LiveStream()
        self.link: RigLink | None = None

    @property
    def is_there(self) -> bool:
        """Whether a driver has said something in the last seconds."""
        return self.link is not None and time.monotonic() - self.link.heard_at < _SILENT_S

    def connect(self, namespace: str, domain: int | None = None) -> str:
        """Join the graph in a thread of its own; returns why not, empty where it was done. domain: None: the user's."""
        try:
            from hasel_sysid.workbench.live.link import RigLink
        except ImportError as error:
            return f"no live mode: {error}"
        self.link = RigLink(self.stream, namespace, domain)
        return ""

    def close(self) -> None:
        """Leave the graph."""
        if self.link is not None:
            self.link.close()

    async def stop(self) -> str:
        """Ask the driver's emergency stop; returns what it says, or that nobody answers."""
        if self.link is None:
            return "no rig is connected: use the mushroom switch"
        return await self.link.stop()

    def said(self) -> str:
        """What the supply says of itself, in a line."""
        if self.link is None or self.link.state is None or not self.is_there:
            return "no rig is heard"
        state = self.link.state
        words = [_MODES[state.mode] if state.mode < len(_MODES) else "unknown"]
        words.append("grounded" if state.grounded else "not proven grounded")
        if state.fault_text:
            words.append(state.fault_text)
        return ", ".join(words)

    def run(self, manoeuvre: Manoeuvre, progress: Progress) -> str:
        """Have the driver make a run; returns what it says. Raises SysidError where it refuses or nobody is there."""
        if self.link is None or not self.is_there:
            raise SysidError("no rig is heard; start it, and arm it with the driver's own tools")
        return self.link.run(manoeuvre.goal(), progress)

    def load(self, model: Path) -> str:
        """Let the running simulator take a model file. Raises SysidError where it does not."""
        if self.link is None:
            raise SysidError("no simulator is heard; start the rig's nodes first")
        return self.link.load(model)
