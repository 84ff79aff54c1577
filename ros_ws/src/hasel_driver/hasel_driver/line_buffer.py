"""Cuts a byte stream into lines."""

from hasel_driver.protocol import MAXIMUM_LINE_LENGTH


class LineBuffer:
    """Collects bytes as they come; an endless line is handed out in pieces too long to be valid."""

    def __init__(self) -> None:
        self._pending = b""

    def feed(self, data: bytes) -> list[bytes]:
        """Whole lines, without line ends and without empty ones, in order."""
        *lines, self._pending = (self._pending + data).split(b"\n")
        if len(self._pending) > 2 * MAXIMUM_LINE_LENGTH:
            lines.append(self._pending)
            self._pending = b""
        return [line for line in (line.rstrip(b"\r") for line in lines) if line]

    def clear(self) -> None:
        """Forget a line that has only begun."""
        self._pending = b""
