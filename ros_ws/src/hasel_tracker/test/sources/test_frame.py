import threading
import time

from hasel_tracker.sources.camera_source import CaptureThread
from hasel_tracker.sources.frame import DropOldestQueue, Frame


def test_oldest_goes_first_and_is_counted():
    """Five items into three places: the two oldest are gone and counted, the rest comes in order."""
    queue = DropOldestQueue(3)
    for item in range(5):
        queue.put(item)
    assert queue.dropped == 2
    assert [queue.get() for _ in range(3)] == [2, 3, 4]


def test_get_waits_for_an_item_and_gives_up_when_closed():
    """A reader waits for a writer, gets None after its time-out, and is let go when the queue closes."""
    queue = DropOldestQueue(2)
    assert queue.get(timeout_s=0.01) is None
    threading.Timer(0.05, lambda: queue.put("late")).start()
    assert queue.get(timeout_s=2.0) == "late"
    threading.Timer(0.05, queue.close).start()
    assert queue.get(timeout_s=2.0) is None
    assert queue.closed


def test_slow_reader_does_not_hold_up_the_capture():
    """While the reader sleeps the camera is read on; the newest frames are kept, the others counted."""
    left = iter(range(200))

    def read() -> Frame | None:
        index = next(left, None)
        return None if index is None else Frame(index, index / 120)

    queue = DropOldestQueue(8)
    capture = CaptureThread(read, queue)
    start = time.monotonic()
    capture.start()
    while not queue.closed and time.monotonic() - start < 5.0:
        time.sleep(0.01)
    assert capture.captured == 200
    assert queue.dropped == 192
    assert [queue.get().index for _ in range(8)] == list(range(192, 200))
