"""Capture, decode and track in threads; hand every tracked frame on as soon as it is ready."""

import threading
import time
from collections.abc import Callable, Iterator

from hasel_tracker.errors import TrackerError
from hasel_tracker.live.health import TrackingStatistics
from hasel_tracker.sources.camera_source import CaptureThread
from hasel_tracker.sources.decoding import decoded_in_order
from hasel_tracker.sources.frame import DropOldestQueue, Frame
from hasel_tracker.tracking.bending_tracker import BendingTracker, TrackedFrame
from hasel_tracker.video.video_writer import VideoRecorder

IDLE_S = 0.2


class LiveTracker:
    """Runs `tracker` on the frames of `queue`, which `read` (if given) fills from a thread of its own.

    `publish` is called in the tracking thread with each frame and what was found in it. `stop` ends the
    threads.
    """

    def __init__(
        self,
        tracker: BendingTracker,
        publish: Callable[[Frame, TrackedFrame], None],
        queue_size: int = 8,
        decode_threads: int = 2,
        read: Callable[[], Frame | None] | None = None,
    ) -> None:
        self.tracker = tracker
        self.queue: DropOldestQueue[Frame] = DropOldestQueue(queue_size)
        self.statistics = TrackingStatistics()
        self.fault = ""
        self.broken_frames = 0
        self._publish = publish
        self._decode_threads = decode_threads
        self._capture = None if read is None else CaptureThread(read, self.queue)
        self._thread = threading.Thread(target=self._run, name="tracking", daemon=True)
        self._recorder: VideoRecorder | None = None
        self._recorder_lock = threading.Lock()

    def start(self) -> None:
        """Begin to capture and track."""
        self._thread.start()
        if self._capture is not None:
            self._capture.start()

    def stop(self) -> None:
        """Stop capturing, track what is queued, finish a video being recorded."""
        if self._capture is not None:
            self._capture.stop()
        self.queue.close()
        if self._thread.is_alive():
            self._thread.join(timeout=5.0)
        if self.recording is not None:
            self.record_until_now()

    @property
    def running(self) -> bool:
        """Whether frames may still come."""
        return self._thread.is_alive()

    @property
    def recording(self) -> VideoRecorder | None:
        """The video being recorded, or None."""
        return self._recorder

    def record(self, recorder: VideoRecorder) -> None:
        """Write the frames from now on; raises TrackerError if a video is being recorded already."""
        with self._recorder_lock:
            if self._recorder is not None:
                raise TrackerError(f"{self._recorder.path} is being recorded already; stop that video first.")
            self._recorder = recorder

    def record_until_now(self) -> str:
        """Finish the video being recorded and say what is in it; raises TrackerError if there is none."""
        with self._recorder_lock:
            recorder, self._recorder = self._recorder, None
        if recorder is None:
            raise TrackerError("No video is being recorded; start one first.")
        return recorder.close()

    def _run(self) -> None:
        for frame in decoded_in_order(self._arriving(), self._decode_threads, self._note_broken):
            with self._recorder_lock:
                if self._recorder is not None:
                    self._recorder.add(frame)
            try:
                tracked = self.tracker.update(frame.image, frame.time_s)
            except TrackerError as error:
                self.fault = str(error)
                continue
            self._publish(frame, tracked)
            self.statistics.add(tracked, frame.stamp_ns, time.time_ns())

    def _arriving(self) -> Iterator[Frame | None]:
        while not (self.queue.closed and len(self.queue) == 0):
            yield self.queue.get(IDLE_S)

    def _note_broken(self, error: TrackerError) -> None:
        self.broken_frames += 1
        self.fault = str(error)
