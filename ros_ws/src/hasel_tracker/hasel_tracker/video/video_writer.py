# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Write video: H.264 for people, MJPEG for measuring and for live recording; both keep the frames' times."""

import threading
from fractions import Fraction
from pathlib import Path

import av
import cv2
import numpy as np
from av.container import OutputContainer

from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.frame import DropOldestQueue, Frame

TIME_BASE = Fraction(1, 90_000)
JPEG_QUALITY = 90
SUFFIXES = (".mp4", ".mov", ".mkv", ".avi")
# A file in fragments is readable up to the last half second when its writer is killed.
FRAGMENTED = {"movflags": "frag_keyframe+empty_moov+default_base_moof", "frag_duration": "500000"}
QUEUE_FRAMES = 120


class H264Writer:
    """H.264 in MP4 or MKV; `constant_rate_factor` 0 (lossless) to 51, 23 is usual."""

    def __init__(self, path: Path, frame_rate_hz: float, constant_rate_factor: int = 20) -> None:
        self._path = path
        self._rate = Fraction(frame_rate_hz).limit_denominator(1000)
        self._quality = {"crf": str(constant_rate_factor), "preset": "veryfast"}
        self._container = _open(path, {})
        self._stream: av.VideoStream | None = None
        self._count = 0

    def write(self, image: np.ndarray, time_s: float | None = None) -> None:
        """Append an 8-bit BGR image; without a time it follows at the frame rate."""
        if self._stream is None:
            self._stream = self._container.add_stream("libx264", rate=self._rate, options=self._quality)
            self._stream.height, self._stream.width = image.shape[:2]
            self._stream.pix_fmt = "yuv420p"
            self._stream.codec_context.time_base = TIME_BASE
        frame = av.VideoFrame.from_ndarray(image, format="bgr24")
        seconds = self._count / float(self._rate) if time_s is None else time_s
        frame.pts, frame.time_base = round(seconds / TIME_BASE), TIME_BASE
        self._count += 1
        _mux(self._container, self._path, self._stream.encode(frame))

    def close(self) -> None:
        """Finish the file."""
        if self._stream is not None:
            _mux(self._container, self._path, self._stream.encode())
        self._container.close()


class JpegWriter:
    """MJPEG in MP4, MOV, MKV or AVI. JPEG pictures are stored as they are; images are compressed first.

    `start_stamp_ns` [ns since the epoch] of time zero is kept in the file, so that it can be merged by stamp.
    """

    def __init__(
        self, path: Path, frame_rate_hz: float, quality: int = JPEG_QUALITY, start_stamp_ns: int | None = None
    ) -> None:
        self._path = path
        self._rate = Fraction(frame_rate_hz).limit_denominator(1000)
        self._quality = quality
        suffix = Path(path).suffix.lower()
        self._container = _open(path, FRAGMENTED if suffix in (".mp4", ".mov") else {})
        self._time_base = 1 / self._rate if suffix == ".avi" else TIME_BASE
        if start_stamp_ns is not None:
            self._container.metadata["comment"] = f"start_stamp_ns={start_stamp_ns}"
        self._stream: av.VideoStream | None = None
        self._count = 0

    def write(self, image: np.ndarray, time_s: float | None = None) -> None:
        """Append an 8-bit BGR image; without a time it follows at the frame rate."""
        settings = [cv2.IMWRITE_JPEG_QUALITY, self._quality]
        self.write_jpeg(cv2.imencode(".jpg", image, settings)[1].tobytes(), image.shape[1::-1], time_s)

    def write_jpeg(self, jpeg: bytes, size_px: tuple[int, int], time_s: float | None = None) -> None:
        """Append a picture of (width, height) that is JPEG code already."""
        if self._stream is None:
            self._stream = self._container.add_stream("mjpeg", rate=self._rate)
            self._stream.width, self._stream.height = size_px
            self._stream.pix_fmt = "yuvj420p"
            self._stream.codec_context.time_base = self._time_base
            self._stream.time_base = self._time_base
        seconds = self._count / float(self._rate) if time_s is None else time_s
        packet = av.Packet(jpeg)
        packet.stream, packet.time_base = self._stream, self._time_base
        packet.pts = packet.dts = round(seconds / self._time_base)
        packet.is_keyframe = True
        self._count += 1
        _mux(self._container, self._path, packet)

    def close(self) -> None:
        """Finish the file."""
        self._container.close()


def _open(path: Path, options: dict[str, str]) -> OutputContainer:
    path = Path(path)
    if not path.parent.is_dir():
        raise TrackerError(
            f"The video {path} cannot be written: there is no folder {path.parent}; make it first."
        )
    if path.suffix.lower() not in SUFFIXES:
        raise TrackerError(f"The video {path} cannot be written; end its name in {', '.join(SUFFIXES)}.")
    try:
        return av.open(str(path), "w", options=options)
    except (av.FFmpegError, OSError) as error:
        raise _unwritable(path, error) from error


def _mux(container: OutputContainer, path: Path, packets: av.Packet | list[av.Packet]) -> None:
    try:
        container.mux(packets)
    except (av.FFmpegError, OSError) as error:
        raise _unwritable(path, error) from error


def _unwritable(path: Path, error: Exception) -> TrackerError:
    return TrackerError(
        f"The video {path} cannot be written ({error}); free some space or choose another place."
    )


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
