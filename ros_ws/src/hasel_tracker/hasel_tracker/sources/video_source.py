"""Frames of a video file, with the times written in it."""

import re
from collections.abc import Iterator
from pathlib import Path

import av
from av.container import InputContainer
from av.video.stream import VideoStream

from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.frame import Frame

COARSE_TIME_S = 2e-4
START_STAMP = re.compile(r"start_stamp_ns=(\d+)")


class VideoSource:
    """A video readable by FFmpeg; `threads` decode it (0: as many as useful)."""

    def __init__(self, path: Path, threads: int = 0) -> None:
        self.path = Path(path)
        self._threads = threads
        try:
            with av.open(str(path)) as container:
                stream = container.streams.video[0]
                self.frame_rate_hz = float(stream.average_rate or stream.guessed_rate or 0.0)
                seconds = float(container.duration or 0) / av.time_base
                self.frame_count = stream.frames or round(seconds * self.frame_rate_hz)
                self.size_px = (stream.width, stream.height)
                comment = container.metadata.get("comment", "") or container.metadata.get("COMMENT", "")
        except (av.FFmpegError, IndexError, OSError) as error:
            raise TrackerError(
                f"{path} cannot be opened as a video ({_reason(error)}); expected a file FFmpeg can read."
            ) from error
        self.damaged_frames = 0
        stamp = START_STAMP.search(comment)
        self.start_stamp_ns = int(stamp.group(1)) if stamp else None

    def __iter__(self) -> Iterator[Frame]:
        """Yield all frames; those that cannot be decoded are left out and counted in `damaged_frames`."""
        self.damaged_frames = 0
        with av.open(str(self.path)) as container:
            stream = container.streams.video[0]
            stream.thread_type = "AUTO"
            stream.codec_context.thread_count = self._threads
            first_s = None
            coarse_s = float(stream.time_base or 0.0)
            for index, picture in enumerate(self._pictures(container, stream)):
                seconds = picture.time if picture.time is not None else index / self.frame_rate_hz
                first_s = seconds if first_s is None else first_s
                yield self._frame(index, self._mended(seconds - first_s, coarse_s), picture)

    def _mended(self, time_s: float, coarse_s: float) -> float:
        """A time that the file rounds to its time base (MKV: 1 ms), put on the frame that the frame rate says."""
        if not COARSE_TIME_S <= coarse_s < 0.5 / max(self.frame_rate_hz, 1e-9):
            return time_s
        even = round(time_s * self.frame_rate_hz) / self.frame_rate_hz
        return even if abs(even - time_s) <= 1.01 * coarse_s else time_s

    def _pictures(self, container: InputContainer, stream: VideoStream) -> Iterator[av.VideoFrame]:
        packets = container.demux(stream)
        while True:
            try:
                packet = next(packets, None)
                if packet is None:
                    return
                yield from packet.decode()
            except av.EOFError:
                return
            except av.FFmpegError:
                self.damaged_frames += 1

    def _frame(self, index: int, time_s: float, picture: av.VideoFrame) -> Frame:
        stamp = None if self.start_stamp_ns is None else self.start_stamp_ns + round(time_s * 1e9)
        return Frame(index, time_s, image=picture.to_ndarray(format="bgr24"), stamp_ns=stamp)


def _reason(error: Exception) -> str:
    return (getattr(error, "strerror", None) or str(error) or type(error).__name__).lower()
