"""Commands of hasel_sysid in processes of their own, as a user types them."""

import os
import time

from hasel_sysid.command_line.running import MISLEADING
from rich.console import Console

from hasel_bringup.demo.processes import Processes
from hasel_bringup.errors import BringupError

_NICENESS = 10  # the supply must not be held up


class Commands:
    """Runs one after the other and shows for how long it has been working."""

    def __init__(self, processes: Processes, console: Console) -> None:
        self._processes, self._console = processes, console

    def run(self, name: str, *arguments: str) -> None:
        """Raises BringupError when the command fails."""
        self._processes.start("hasel_sysid", name, *arguments)
        os.setpriority(os.PRIO_PROCESS, self._processes.process_id(name), _NICENESS)
        begun = time.monotonic()
        with self._console.status("") as status:
            while not self._processes.ended(name):
                status.update(f"{name} has been working for {time.monotonic() - begun:.0f} s")
                time.sleep(0.1)
        code = self._processes.finish(name, 1.0)
        if code not in (0, MISLEADING):
            raise BringupError(f"{name} failed with exit code {code}; see {self._processes.output(name)}")
