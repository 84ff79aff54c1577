# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The device's end of a pseudo-terminal, for supplies that exist only in software."""

import contextlib
import errno
import os
import pty
import select
import tty
from pathlib import Path

from hasel_driver.protocol.faults import PortError

TERMINALS = Path("/dev/pts")


class PseudoTerminal:
    """A serial port to be opened by a host at `path`; with `link`, also under that name, where nothing else has it."""

    def __init__(self, link: Path | None = None) -> None:
        self._link = link
        self.plug()

    def plug(self) -> None:
        """Make the port appear."""
        self._master, host_end = pty.openpty()
        tty.setraw(host_end)
        self.path = os.ttyname(host_end)
        os.close(host_end)  # from here on a hang-up tells that no host is there
        os.set_blocking(self._master, False)
        self._plugged = True
        if self._link is not None:
            self._make_link(self._link)

    def _make_link(self, link: Path) -> None:
        left_over = link.is_symlink() and link.readlink().parent == TERMINALS and not link.exists()
        if left_over:  # by one that was killed
            link.unlink()
        try:
            link.symlink_to(self.path)
        except OSError as error:
            raise PortError(
                f"{link} cannot be made a link to the port ({error.strerror}): name one where nothing is, or remove it."
            ) from error

    def unplug(self) -> None:
        """Make the port vanish, as a pulled cable does."""
        if not self._plugged:
            return
        self._plugged = False
        os.close(self._master)
        if self._link is not None and self._link.is_symlink() and str(self._link.readlink()) == self.path:
            self._link.unlink()

    def fileno(self) -> int | None:
        """File descriptor to wait on; None while unplugged."""
        return self._master if self._plugged else None

    def host_present(self) -> bool:
        """Whether a host has the port open."""
        if not self._plugged:
            return False
        poll = select.poll()
        poll.register(self._master, select.POLLIN)
        return not any(event & select.POLLHUP for _, event in poll.poll(0))

    def read(self) -> bytes:
        """What the host has sent; empty if nothing."""
        if not self._plugged:
            return b""
        try:
            return os.read(self._master, 4096)
        except OSError as error:
            if error.errno in (errno.EAGAIN, errno.EIO):
                return b""
            raise

    def write(self, data: bytes) -> None:
        """Send to the host; a host that does not read loses it, as on a real line."""
        if self._plugged:
            with contextlib.suppress(BlockingIOError):
                os.write(self._master, data)
