"""Record the camera's video on request without slowing the tracker down."""

import threading
from pathlib import Path

from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.frame import Frame
from hasel_tracker.sources.frame_queue import DropOldestQueue
from hasel_tracker.video.video_writer import JpegWriter

QUEUE_FRAMES = 120


class VideoRecorder:
    """Writes frames to an MJPEG video; a camera's JPEG pictures go in unchanged, stamps are kept."""

    def __init__(self, path: Path, frame_rate_hz: float) -> None:
        self.path = Path(path)
        self.written = 0
        self.fault = ""
        self._rate = frame_rate_hz
        self._queue: DropOldestQueue[Frame] = DropOldestQueue(QUEUE_FRAMES)
        self._thread = threading.Thread(target=self._run, name="video", daemon=True)
        self._thread.start()

    @property
    def dropped(self) -> int:
        """Frames that came too fast to be written."""
        return self._queue.dropped

    def add(self, frame: Frame) -> None:
        """Queue a decoded frame for writing."""
        self._queue.put(frame)

    def close(self) -> str:
        """Write what is queued, finish the file, say what is in it; raises TrackerError if writing failed."""
        self._queue.close()
        self._thread.join()
        if self.fault:
            raise TrackerError(self.fault)
        return f"{self.path} holds {self.written} frames, {self.dropped} were dropped."

    def _run(self) -> None:
        writer, first = None, None
        try:
            while (frame := self._queue.get()) is not None:
                if writer is None:
                    first = frame
                    writer = JpegWriter(self.path, self._rate, start_stamp_ns=frame.stamp_ns)
                self._write(writer, frame, frame.time_s - first.time_s)
        except TrackerError as error:
            self.fault = str(error)
        finally:
            if writer is not None:
                writer.close()

    def _write(self, writer: JpegWriter, frame: Frame, time_s: float) -> None:
        if frame.jpeg is not None:
            writer.write_jpeg(frame.jpeg, frame.image.shape[1::-1], time_s)
        else:
            writer.write(frame.image, time_s)
        self.written += 1
