# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A video, a folder of images or a TIFF stack, whichever the user named; played as if it were a camera."""

import re
import time
from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import groupby
from pathlib import Path

import cv2
import numpy as np

from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.frame import Frame
from hasel_tracker.sources.video_source import VideoSource

IMAGE_SUFFIXES = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".webp"}
STACK_SUFFIXES = {".tif", ".tiff"}
DIGITS = re.compile(r"\d+")
MOST_MISSING = 2.0
"""More numbers missing than this many times the pictures there are: the numbers do not count pictures."""


class FolderSource:
    """All images of a folder: one series of one camera, whose number in the name says when each was taken.

    notes: what is missing, one sentence each. Raises TrackerError for no images, and for several series.
    """

    start_stamp_ns = None

    def __init__(self, path: Path, frame_rate_hz: float) -> None:
        self.path = Path(path)
        self.frame_rate_hz = frame_rate_hz
        self.notes: list[str] = []
        self.damaged_frames = 0
        names = [each for each in self.path.iterdir() if _is_picture(each)]
        if not names:
            raise TrackerError(
                f"The folder {path} holds no images; expected {', '.join(sorted(IMAGE_SUFFIXES))} files."
            )
        self._paths = sorted(names, key=_natural_order)
        self._numbers = self._numbered()
        self.frame_count = len(self._paths)

    def __iter__(self) -> Iterator[Frame]:
        """Yield all frames; those that cannot be decoded are left out and counted in `damaged_frames`."""
        self.damaged_frames = 0
        for number, path in zip(self._numbers, self._paths, strict=True):
            image = cv2.imread(str(path), cv2.IMREAD_COLOR)
            if image is None:
                self.damaged_frames += 1
            else:
                yield Frame(number, number / self.frame_rate_hz, image=image)

    def _numbered(self) -> list[int]:
        """The place of each picture in the series, from 0; their order where the names have no numbers."""
        shapes = {DIGITS.sub("#", each.name) for each in self._paths}
        if len(shapes) == len(self._paths):
            return list(range(len(self._paths)))
        numbers = [[int(digits) for digits in DIGITS.findall(each.name)] for each in self._paths]
        counting = [column for column in zip(*numbers, strict=False) if len(set(column)) > 1]
        unique = [column for column in counting if len(set(column)) == len(column)]
        if len(shapes) > 1 or not unique:
            named = ", ".join(each.name for each in self._paths[:: max(1, len(self._paths) - 1)])
            raise TrackerError(
                f"The folder {self.path} holds more than one series of images ({named}); one series of one camera is "
                "expected: put each into a folder of its own."
            )
        return self._places(np.array(unique[-1]))

    def _places(self, numbers: np.ndarray) -> list[int]:
        places = (numbers - numbers.min()) // int(np.gcd.reduce(np.diff(np.sort(numbers))))
        missing = int(places.max()) + 1 - len(places)
        if missing > MOST_MISSING * len(places) or (np.diff(places) < 0).any():
            raise TrackerError(
                f"The folder {self.path} has {len(places)} images, numbered {numbers.min()} to {numbers.max()}: these "
                "numbers do not count pictures (are they times?); number them one by one."
            )
        if missing:
            self.notes.append(f"{missing} pictures are missing by their numbers; the others keep their times")
        return places.tolist()


class StackSource:
    """The pages of one image file; see FolderSource."""

    start_stamp_ns = None
    notes: tuple[str, ...] = ()

    def __init__(self, path: Path, frame_rate_hz: float) -> None:
        self.path, self.frame_rate_hz = Path(path), frame_rate_hz
        self.damaged_frames = 0
        self.frame_count = pages(path)
        if not self.frame_count:
            raise TrackerError(f"{path} is not a readable image; write it again.")

    def __iter__(self) -> Iterator[Frame]:
        """Yield all pages; those that cannot be decoded are left out and counted in `damaged_frames`."""
        self.damaged_frames = 0
        for number in range(self.frame_count):
            read, images = cv2.imreadmulti(str(self.path), number, 1, flags=cv2.IMREAD_COLOR)
            if read and images:
                yield Frame(number, number / self.frame_rate_hz, image=images[0])
            else:
                self.damaged_frames += 1


def pages(path: Path) -> int:
    """How many pictures an image file holds; 0 for one that cannot be read."""
    return int(cv2.imcount(str(path))) if cv2.haveImageReader(str(path)) else 0


def stacks(folder: Path) -> list[Path]:
    """The files of a folder that hold more than one picture."""
    return sorted(p for p in folder.iterdir() if p.suffix.lower() in STACK_SUFFIXES and pages(p) > 1)


def _is_picture(path: Path) -> bool:
    return path.suffix.lower() in IMAGE_SUFFIXES and not path.name.startswith(".")


def _natural_order(path: Path) -> list[tuple[bool, int, str]]:
    parts = ("".join(part) for _, part in groupby(path.name, str.isdecimal))
    return [(part.isdecimal(), int(part) if part.isdecimal() else 0, part) for part in parts]


def open_recorded(
    path: str | Path,
    frame_rate_hz: float | None = None,
    threads: int = 0,
    unsaid_hz: float | None = None,
) -> VideoSource | FolderSource | StackSource:
    """Open a video file, a folder of images or a TIFF stack.

    frame_rate_hz: how fast the pictures were taken [1/s], whatever the source says; unsaid_hz: the same where the
    source does not say it. Raises TrackerError where neither is known.
    """
    path = Path(path)
    if not path.exists():
        raise TrackerError(f"{path} does not exist; give a video file or a folder of images.")
    if frame_rate_hz is not None and not 0.0 < frame_rate_hz < float("inf"):
        raise TrackerError(
            f"A frame rate of {frame_rate_hz:g} was given; expected pictures per second, above 0."
        )
    of_images = path.is_dir() or path.suffix.lower() in STACK_SUFFIXES
    if not of_images:
        return VideoSource(path, threads, frame_rate_hz, unsaid_hz)
    rate = frame_rate_hz or unsaid_hz
    if rate is None:
        what = "a folder of images" if path.is_dir() else "a stack of images"
        raise TrackerError(f"{path} is {what}; say how fast they were taken with --frame-rate.")
    if not path.is_dir():
        return StackSource(path, rate)
    found = stacks(path)
    if found:
        raise TrackerError(
            f"{found[0]} holds many pictures and lies in a folder; name that file, not its folder."
        )
    return FolderSource(path, rate)


class Playback:
    """Gives each frame when its time has come, stamped with the start of the playback plus the frame's own time."""

    def __init__(self, frames: Iterable[Frame]) -> None:
        self._frames: Iterator[Frame] = iter(frames)
        self._start: float | None = None
        self._start_ns = 0

    def read(self) -> Frame | None:
        """The next frame, when it is due; None at the end."""
        frame = next(self._frames, None)
        if frame is None:
            return None
        now = time.monotonic()
        if self._start is None:
            self._start, self._start_ns = now - frame.time_s, time.time_ns() - round(frame.time_s * 1e9)
        time.sleep(max(self._start + frame.time_s - now, 0.0))
        return replace(frame, stamp_ns=self._start_ns + round(frame.time_s * 1e9))
