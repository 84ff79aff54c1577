"""Decode JPEG frames in several threads, and hand them on in order."""

from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor

from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.frame import Frame


def decoded_in_order(
    frames: Iterator[Frame], threads: int, broken: Callable[[TrackerError], None] | None = None
) -> Iterator[Frame]:
    """Decoded frames in the order of `frames`; at most `threads` are being decoded at a time.

    A frame that cannot be decoded raises TrackerError, or is left out and told to `broken` if that is given.
    """
    with ThreadPoolExecutor(threads, thread_name_prefix="decode") as pool:
        waiting: deque[Future[Frame]] = deque()
        for frame in frames:
            waiting.append(pool.submit(frame.decoded))
            while waiting and (len(waiting) >= threads or waiting[0].done()):
                yield from _result(waiting.popleft(), broken)
        while waiting:
            yield from _result(waiting.popleft(), broken)


def _result(future: Future[Frame], broken: Callable[[TrackerError], None] | None) -> Iterator[Frame]:
    try:
        yield future.result()
    except TrackerError as error:
        if broken is None:
            raise
        broken(error)
