"""When to send a frame."""

import time


class ReplayClock:
    """Real time times `rate`; rate infinite: at once."""

    def __init__(self, rate: float) -> None:
        self._rate = rate
        self._origin: tuple[float, int] | None = None

    def start(self, stamp_ns: int) -> None:
        """Let this stamp [ns] be now."""
        self._origin = time.monotonic(), stamp_ns

    def wait_for(self, stamp_ns: int) -> None:
        """Sleep until a stamp [ns] is due; late ones are not waited for."""
        begun, first_ns = self._origin
        due = begun + (stamp_ns - first_ns) * 1e-9 / self._rate
        time.sleep(max(0.0, due - time.monotonic()))
