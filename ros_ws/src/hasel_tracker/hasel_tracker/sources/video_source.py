# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Frames of a video file as it is meant to be seen: its times, the shape of its pixels, its fields, its orientation.

FFmpeg (through PyAV) says all of this of a file; what it does not say is refused or stated by the user.
"""

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

import av
import av.filter
import numpy as np
from av.container import InputContainer
from av.sidedata.sidedata import Type as SideData
from av.video.reformatter import Interpolation
from av.video.stream import VideoStream

from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.frame import Frame

COARSE_TIME_S = 2e-4
START_STAMP = re.compile(r"start_stamp_ns=(\d+)")
CAPTURE_RATES = ("com.android.capture.fps",)
"""Metadata in which phones say how fast a slow-motion or time-lapse video was taken."""
SAME_RATE = 0.05
MOST_PIXELS = 60_000_000
NO_TIMES = 0x80  # AVFMT_NOTIMESTAMPS
FIELDS = "mode=send_field:deint=interlaced"


class VideoSource:
    """A video readable by FFmpeg; `threads` decode it (0: as many as useful).

    frame_rate_hz: at which the pictures were taken, in place of what the file says; unsaid_hz: where it does not say
    so. notes: what was made of the file, one sentence each. Raises TrackerError for no video, and for one whose times
    are neither written in it nor given.
    """

    def __init__(
        self,
        path: Path,
        threads: int = 0,
        frame_rate_hz: float | None = None,
        unsaid_hz: float | None = None,
    ) -> None:
        self.path = Path(path)
        self._threads = threads
        self.notes: list[str] = []
        self.damaged_frames = 0
        try:
            with av.open(str(path)) as container:
                self._look(container, frame_rate_hz, unsaid_hz)
        except (av.FFmpegError, IndexError, OSError, ValueError) as error:
            raise TrackerError(
                f"{path} cannot be opened as a video ({_reason(error)}); expected a file FFmpeg can read."
            ) from error

    def _look(self, container: InputContainer, given_hz: float | None, unsaid_hz: float | None) -> None:
        stream = container.streams.video[0]
        if stream.codec_context is None:
            raise ValueError("its codec is not known")
        stored_hz = float(stream.average_rate or stream.guessed_rate or 0.0)
        seconds = float(container.duration or 0) / av.time_base
        count = stream.frames or round(seconds * stored_hz)
        first = next(iter(self._pictures(container, stream)), None)
        timed = first is None or (first.pts is not None and not container.format.flags & NO_TIMES)
        given_hz = given_hz or (None if timed and stored_hz > 0.0 else unsaid_hz)
        self._even = given_hz is not None
        if not self._even and not (timed and stored_hz > 0.0):
            raise TrackerError(
                f"{self.path} says of no picture when it was taken (a raw {container.format.name} stream); say how "
                "fast they were taken with --frame-rate."
            )
        fields = 2 if first is not None and first.interlaced_frame else 1
        self.frame_count = count * fields
        self._stored_hz = stored_hz * fields
        self.frame_rate_hz = given_hz or self._captured_hz(container, stream)
        self._interlaced = fields == 2
        if self._interlaced:
            self.notes.append(
                f"it is interlaced: every picture is taken apart into two, {self.frame_rate_hz:.6g} per second"
            )
        aspect = float(stream.sample_aspect_ratio or 1.0) or 1.0
        self.size_px = (
            round(stream.width * max(aspect, 1.0)),
            round(stream.height * max(1.0 / aspect, 1.0)),
        )
        if self.size_px[0] * self.size_px[1] > MOST_PIXELS:
            raise TrackerError(
                f"{self.path} says that its pictures are {self.size_px[0]} × {self.size_px[1]} px, which no camera "
                "takes; its header is damaged: copy it again."
            )
        self._shaped = aspect != 1.0
        if self._shaped:
            width, height = self.size_px
            self.notes.append(f"its pixels are not square: it is drawn out to {width} × {height} px")
        comment = container.metadata.get("comment", "") or container.metadata.get("COMMENT", "")
        stamp = START_STAMP.search(comment)
        self.start_stamp_ns = int(stamp.group(1)) if stamp else None

    def _captured_hz(self, container: InputContainer, stream: VideoStream) -> float:
        """The rate at which the pictures were taken: what a phone says of slow motion, else the stored one."""
        said = {**stream.metadata, **container.metadata}
        captured = [float(said[key]) for key in CAPTURE_RATES if key in said]
        if not captured or not captured[0] > 0.0 or abs(captured[0] / self._stored_hz - 1.0) < SAME_RATE:
            return self._stored_hz
        self.notes.append(
            f"it was taken at {captured[0]:g} pictures per second and is stored at {self._stored_hz:g}, so the times "
            "are those of taking them"
        )
        return captured[0]

    def __iter__(self) -> Iterator[Frame]:
        """Yield all frames; those that cannot be decoded are left out and counted in `damaged_frames`."""
        self.damaged_frames = 0
        with av.open(str(self.path)) as container:
            stream = container.streams.video[0]
            stream.thread_type = "AUTO"
            stream.codec_context.thread_count = self._threads
            pictures: Iterable[av.VideoFrame] = self._pictures(container, stream)
            if self._interlaced:
                pictures = _fields(pictures, stream)
            first_s = None
            coarse_s = float(stream.time_base or 0.0)
            slower = self._stored_hz / self.frame_rate_hz
            for index, picture in enumerate(pictures):
                number = index + self.damaged_frames
                if self._even or picture.time is None:
                    yield self._frame(index, number / self.frame_rate_hz, picture)
                    continue
                first_s = picture.time if first_s is None else first_s
                yield self._frame(index, slower * self._mended(picture.time - first_s, coarse_s), picture)

    def _mended(self, time_s: float, coarse_s: float) -> float:
        """A time that the file rounds to its time base (MKV: 1 ms), put on the frame that the frame rate says."""
        if not COARSE_TIME_S <= coarse_s < 0.5 / max(self._stored_hz, 1e-9):
            return time_s
        even = round(time_s * self._stored_hz) / self._stored_hz
        return even if abs(even - time_s) <= 1.01 * coarse_s else time_s

    def _pictures(self, container: InputContainer, stream: VideoStream) -> Iterator[av.VideoFrame]:
        """What can be decoded. AVI keeps times in the order of decoding: pictures get them in the order of showing."""
        in_order = iter(self._stored_times(container) if container.format.name == "avi" else ())
        packets = container.demux(stream)
        while True:
            try:
                packet = next(packets, None)
                if packet is None:
                    return
                for picture in packet.decode():
                    picture.pts = next(in_order, picture.pts)
                    yield picture
            except av.EOFError:
                return
            except (
                av.FFmpegError,
                ValueError,
            ):  # ValueError: a picture whose size or format became senseless
                self.damaged_frames += 1

    def _stored_times(self, container: InputContainer) -> list[int]:
        times = sorted(
            packet.dts for packet in container.demux(video=0) if packet.size and packet.dts is not None
        )
        container.seek(0)
        return times

    def _frame(self, index: int, time_s: float, picture: av.VideoFrame) -> Frame:
        stamp = None if self.start_stamp_ns is None else self.start_stamp_ns + round(time_s * 1e9)
        if self._shaped:
            picture = picture.reformat(*self.size_px, "bgr24", interpolation=Interpolation.BICUBIC)
        image = _upright(picture.to_ndarray(format="bgr24"), picture)
        return Frame(index, time_s, image=image, stamp_ns=stamp)


def _fields(pictures: Iterable[av.VideoFrame], stream: VideoStream) -> Iterator[av.VideoFrame]:
    """The two moments of each interlaced picture, every one filled up to full height."""
    graph = av.filter.Graph()
    source, sink = graph.add_buffer(template=stream), graph.add("buffersink")
    apart = graph.add("bwdif", FIELDS)
    source.link_to(apart)
    apart.link_to(sink)
    graph.configure()
    for picture in (*pictures, None):
        source.push(picture)
        while True:
            try:
                yield sink.pull()
            except (av.BlockingIOError, av.EOFError):
                break


def _upright(image: np.ndarray, picture: av.VideoFrame) -> np.ndarray:
    """The image as the file says that it is to be shown: turned by quarters, mirrored."""
    matrix = picture.side_data.get(SideData.DISPLAYMATRIX)
    if matrix is None:
        return image
    (a, b, _), (c, d, _), _ = np.frombuffer(matrix, np.int32).reshape(3, 3).tolist()
    if abs(b) > abs(a):
        image, a, d = image.transpose(1, 0, 2), c, b
    return np.ascontiguousarray(image[:: -1 if d < 0 else 1, :: -1 if a < 0 else 1])


def _reason(error: Exception) -> str:
    return (getattr(error, "strerror", None) or str(error) or type(error).__name__).lower()
