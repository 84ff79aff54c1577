# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`calibrate colour|body|board|distance`: the markers' colour, how a body stands out, lens and scale."""

import argparse
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np

from hasel_tracker.calibration import VIEWS_FOR_LENS
from hasel_tracker.calibration.camera_calibration import (
    Board,
    calibrate_camera,
    find_corners,
    scale_calibration,
)
from hasel_tracker.calibration.learned_settings import body_picture, learn_body, learn_colour, learned_picture
from hasel_tracker.errors import TrackerError, run_command
from hasel_tracker.sources.recorded_source import IMAGE_SUFFIXES
from hasel_tracker.sources.video_source import VideoSource
from hasel_tracker.tracking.bending_tracker import within
from hasel_tracker.tracking.tracker_settings import save_settings


def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code."""
    work = {"colour": _colour, "body": _body, "board": _board, "distance": _distance}[options.kind]
    return run_command(lambda: work(options))


def _colour(options: argparse.Namespace) -> None:
    image = _image(options.frame)
    learned = learn_colour(image, None if options.at is None else np.array(options.at))
    print(learned)
    save_settings(learned.settings, options.output)
    print(f"Wrote {options.output}.")
    _show(options.show, lambda: learned_picture(image, learned))


def _body(options: argparse.Namespace) -> None:
    image, _ = within(_image(options.frame), options.roi)
    learned = learn_body(image, options.body)
    print(learned)
    save_settings(learned.settings, options.output)
    print(f"Wrote {options.output}.")
    _show(options.show, lambda: body_picture(image, learned))


def _show(path: Path | None, draw: Callable[[], np.ndarray]) -> None:
    if path is None:
        return
    if not cv2.imwrite(str(path), draw()):
        raise TrackerError(f"The picture {path} cannot be written; end its name in .png.")
    print(f"Wrote {path}.")


def _board(options: argparse.Namespace) -> None:
    board = Board(options.columns, options.rows, options.square)
    images = {path: _image(path) for path in [options.plane, *options.images]}
    sizes = {image.shape[1::-1] for image in images.values()}
    if len(sizes) > 1:
        raise TrackerError(
            f"The pictures have different sizes ({sizes}); take all with the same camera format."
        )
    corners = {path: find_corners(image, board, str(path)) for path, image in images.items()}
    calibration = calibrate_camera(list(corners.values()), corners[options.plane], board, sizes.pop())
    if len(images) < VIEWS_FOR_LENS:
        print(f"Perspective only: {len(images)} views, the lens needs at least {VIEWS_FOR_LENS}.")
    calibration.save(options.output)
    print(calibration)
    print(f"Wrote {options.output}.")


def _distance(options: argparse.Namespace) -> None:
    image = _image(options.frame)
    calibration = scale_calibration(*np.array(options.between), options.metres, image.shape[1::-1])  # type: ignore[call-arg]
    calibration.save(options.output)
    print(
        f"{1e3 * calibration.pixel_to_plane[0, 0]:.5g} mm per pixel; lens and perspective are not corrected."
    )
    print(f"Wrote {options.output}.")


def _image(path: Path) -> np.ndarray:
    if not path.is_file():
        raise TrackerError(f"There is no image {path}; check the name.")
    if path.suffix.lower() in IMAGE_SUFFIXES:
        image = cv2.imread(str(path), cv2.IMREAD_COLOR)
        if image is None:
            raise TrackerError(f"{path} is not a readable image; give a PNG or JPEG file.")
        return image
    return next(iter(VideoSource(path, threads=1))).image
