"""Photographs as what lies behind the swimmer."""

from pathlib import Path

import cv2
import numpy as np
from hasel_tracker.errors import TrackerError


def photograph(path: Path, width_px: int, height_px: int) -> np.ndarray:
    """An image file scaled to fill a picture of this size, cropped in the middle; 8-bit BGR."""
    image = cv2.imread(str(path), cv2.IMREAD_COLOR)
    if image is None:
        raise TrackerError(f"The background {path} is not a readable image; give a PNG or JPEG file.")
    return filling(image, width_px, height_px)


def filling(image: np.ndarray, width_px: int, height_px: int) -> np.ndarray:
    """An 8-bit BGR or grey image scaled to fill a picture of this size, cropped in the middle; BGR."""
    if image.ndim == 2:
        image = cv2.cvtColor(image, cv2.COLOR_GRAY2BGR)
    scale = max(width_px / image.shape[1], height_px / image.shape[0])
    size = max(round(image.shape[1] * scale), width_px), max(round(image.shape[0] * scale), height_px)
    large = cv2.resize(image, size, interpolation=cv2.INTER_CUBIC)
    left, top = (size[0] - width_px) // 2, (size[1] - height_px) // 2
    return np.ascontiguousarray(large[top : top + height_px, left : left + width_px])
