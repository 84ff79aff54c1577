"""Frames of a folder of images, in the natural order of their names."""

import re
from collections.abc import Iterator
from pathlib import Path

import cv2

from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.frame import Frame

IMAGE_SUFFIXES = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".webp"}


class FolderSource:
    """All images of a folder, taken at a constant rate."""

    start_stamp_ns = None
    damaged_frames = 0

    def __init__(self, path: Path, frame_rate_hz: float) -> None:
        self.path = Path(path)
        self.frame_rate_hz = frame_rate_hz
        names = [each for each in self.path.iterdir() if each.suffix.lower() in IMAGE_SUFFIXES]
        if not names:
            raise TrackerError(
                f"The folder {path} holds no images; expected {', '.join(sorted(IMAGE_SUFFIXES))} files."
            )
        self._paths = sorted(names, key=_natural_order)
        self.frame_count = len(self._paths)

    def __iter__(self) -> Iterator[Frame]:
        for index, path in enumerate(self._paths):
            image = cv2.imread(str(path), cv2.IMREAD_COLOR)
            if image is None:
                raise TrackerError(f"{path} is not a readable image; remove it or write it again.")
            yield Frame(index, index / self.frame_rate_hz, image=image)


def _natural_order(path: Path) -> list[tuple[bool, int, str]]:
    parts = re.findall(r"\d+|\D+", path.name)
    return [(part.isdigit(), int(part) if part.isdigit() else 0, part) for part in parts]
