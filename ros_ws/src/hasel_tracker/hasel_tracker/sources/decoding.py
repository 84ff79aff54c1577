"""Decode JPEG frames in several threads, and hand them on in order."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor

from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.frame import Frame


def decoded_in_order(
    frames: Iterable[Frame | None], threads: int, broken: Callable[[TrackerError], None]
) -> Iterator[Frame]:
    """Decoded frames in the order of `frames`, at most `threads` of them being decoded at a time.

    None among the frames means that none has come lately: what is waiting is handed on. A frame that cannot
    be decoded is left out and `broken` is told why. With one thread, decoding is done in the calling one.
    """
    if threads == 1:
        yield from _decoded_here(frames, broken)
        return
    with ThreadPoolExecutor(threads, thread_name_prefix="decode") as pool:
        waiting: deque[Future[Frame]] = deque()
        for frame in frames:
            if frame is not None:
                waiting.append(pool.submit(frame.decoded))
            while waiting and (frame is None or len(waiting) >= threads or waiting[0].done()):
                yield from _result(waiting.popleft().result, broken)
        while waiting:
            yield from _result(waiting.popleft().result, broken)


def _decoded_here(frames: Iterable[Frame | None], broken: Callable[[TrackerError], None]) -> Iterator[Frame]:
    for frame in frames:
        if frame is not None:
            yield from _result(frame.decoded, broken)


def _result(decode: Callable[[], Frame], broken: Callable[[TrackerError], None]) -> Iterator[Frame]:
    try:
        yield decode()
    except TrackerError as error:
        broken(error)
