# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Videos, folders and image messages of a few pictures, and drives that do not go with them, one for each fault."""

from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace

import av
import cv2
import numpy as np
from hasel_recording import DriveChannel
from hasel_tracker.offline.drive import (
    Drive,
    align_by_hand,
    align_by_lamp,
    align_by_response,
    align_by_stamp,
    read_drive,
)
from hasel_tracker.offline.tracked_run import TrackedRun
from hasel_tracker.sources.frame import Frame, image_of
from hasel_tracker.sources.recorded_source import open_recorded
from hasel_tracker.sources.video_source import VideoSource

SMALL = np.full((96, 128, 3), 90, np.uint8)


def _video(path: Path, container: str | None = None, aspect: int = 1, **options: str) -> Path:
    with av.open(str(path), "w", format=container, options={"movflags": "use_metadata_tags"}) as file:
        file.metadata.update({key: value for key, value in options.items() if "." in key})
        own = {key: value for key, value in options.items() if "." not in key}
        stream = file.add_stream("libx264", rate=30, options=own)
        stream.width, stream.height, stream.pix_fmt = 128, 96, "yuv420p"
        stream.codec_context.sample_aspect_ratio = aspect
        for number in range(4):
            frame = av.VideoFrame.from_ndarray(SMALL, format="bgr24")
            frame.pts = number
            file.mux(stream.encode(frame))
        file.mux(stream.encode())
    return path


def _folder(path: Path, *names: str) -> Path:
    path.mkdir()
    for name in names:
        cv2.imwrite(str(path / name), SMALL[:8, :8])
    return path


def inputs(folder: Path) -> Iterator[Callable]:
    """Each a call that opens one faulty source; what is said of a video that can be used is its notes."""

    def notes(path: Path) -> list[str]:
        return list(open_recorded(path, 10.0 if path.is_dir() else None).notes)

    for path, rate in (
        (folder / "none.mp4", None),
        (_video(folder / "raw.h264", "h264"), None),
        (_video(folder / "run.mp4"), -1.0),
        (_folder(folder / "empty"), 10.0),
        (_folder(folder / "two", *(f"{side}_{n}.png" for side in ("left", "right") for n in range(3))), 10.0),
        (
            _folder(folder / "times", *(f"{n}.png" for n in (1699999999123, 1699999999156, 1699999999190))),
            10.0,
        ),
        (folder / "two", None),
    ):
        yield lambda path=path, rate=rate: open_recorded(path, rate)
    (folder / "notes.mp4").write_text("not a video")
    yield lambda: VideoSource(folder / "notes.mp4")
    (folder / "broken.tif").write_text("no picture")
    yield lambda: open_recorded(folder / "broken.tif", 10.0)
    stack = _folder(folder / "stack") / "stack.tif"
    cv2.imwritemulti(str(stack), [SMALL[:8, :8]] * 3)
    yield lambda: open_recorded(stack)
    yield lambda: open_recorded(stack.parent, 10.0)
    for path in (
        _folder(folder / "gap", *(f"{n}.png" for n in (7, 8, 11))),
        _video(folder / "slow.mp4", **{"com.android.capture.fps": "240.0"}),
        _video(folder / "wide.mp4", aspect=2),
        _video(folder / "fields.mp4", flags="+ildct+ilme", x264opts="tff=1"),
    ):
        yield lambda path=path: notes(path)
    yield from _messages()
    yield from _drives(folder)


def _messages() -> Iterator[Callable]:
    for message in (
        SimpleNamespace(encoding="mono8", width=8, height=8, step=8, data=bytes(64), is_bigendian=0),
        SimpleNamespace(encoding="bgr8", width=9, height=9, step=27, data=b"123", is_bigendian=0),
        SimpleNamespace(format="jpeg", data=b"garbage"),
    ):
        yield lambda message=message: image_of(message)
    yield lambda: Frame(0, 0.0, jpeg=b"garbage").decoded()


def _drives(folder: Path) -> Iterator[Callable]:
    time = np.arange(240) / 120
    swing = 0.3 * np.sin(4 * np.pi * time)
    shake = 0.1 * np.random.default_rng(0).normal(size=240)
    shake[:60] = 1e-4 * shake[:60]
    markers, trust = np.zeros((240, 3, 2)), np.ones((240, 3))

    def seen(angle: np.ndarray, stamp_ns: int | None = None) -> TrackedRun:
        return TrackedRun(time, angle, np.arcsin(angle), markers, trust, stamp_ns)

    box = Drive(np.array([0.0, 0.6, 1.1, 1.6]), 5000.0 * np.array([[0, 0], [1, 0], [0, 1], [0, 0]]))
    chamber = Drive(box.time_s, box.values[:, :1], channels=(DriveChannel("chamber", "pressure", "Pa"),))
    day_ns = 86_400_000_000_000
    yield lambda: read_drive(folder / "drive.xlsx")
    yield lambda: align_by_stamp(seen(swing), box)
    yield lambda: align_by_stamp(seen(swing, day_ns), Drive(box.time_s, box.values, 2 * day_ns))
    yield lambda: align_by_response(seen(swing), chamber)
    yield lambda: align_by_hand(9.0, seen(swing), box)
    yield lambda: align_by_lamp(seen(swing), box, np.full(240, 20.0))
    yield lambda: align_by_response(seen(np.where(time < 0.1, swing, np.nan)), box)
    yield lambda: align_by_response(seen(swing), Drive(box.time_s, 0 * box.values))
    yield lambda: align_by_response(seen(swing), Drive(box.time_s, 0 * box.values + (5000.0, 0.0)))
    yield lambda: align_by_response(seen(swing), box)
    yield lambda: align_by_response(seen(shake), box)
