# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What goes wrong at a rig: hidden markers, other blue things, lost order, leaving the picture."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import cv2
import numpy as np
from hasel_tracker.offline.tracked_run import track_frames
from hasel_tracker.sources.frame import Frame
from hasel_tracker.tracking.bending_tracker import BendingTracker

from hasel_tracker_lab.bench.accuracy import FRAME_RATE_HZ
from hasel_tracker_lab.rendering.camera_model import CameraView, Degradation
from hasel_tracker_lab.rendering.renderer import RenderedFrame, Renderer
from hasel_tracker_lab.rendering.swimmer_motion import BendingMotion, SampledMotion

CAMERA = Degradation(noise_levels=2.0, jpeg_quality=75)
HIDDEN_FROM, HIDDEN_FRAMES = 12, 10
BLUE = (168, 72, 22)
WRONG_PX = 0.5


@dataclass(frozen=True)
class Robustness:
    """Of a case: frames, frames in which a marker cannot be seen, false angles, and frames late to recover.

    `false_angles` counts frames with an angle although a marker was hidden, or with one from wrong positions;
    `late_frames` those without an angle although every marker was in view. Frames held back in doubt count as soon as
    a later one vouches for them.
    """

    case: str
    frames: int
    unseen_frames: int
    false_angles: int
    late_frames: int

    def __str__(self) -> str:
        return (
            f"{self.case}: {self.unseen_frames} of {self.frames} frames without a marker, "
            f"{self.false_angles} false angles, {self.late_frames} frames late."
        )


Pictures = Iterator[tuple[RenderedFrame, bool]]


def marker_hidden(count: int, width_px: int) -> Pictures:
    """The tail marker is covered for ten frames of a beat."""
    return _covered(BendingMotion(), (2,), count, width_px)


def all_hidden_while_swimming(count: int, width_px: int) -> Pictures:
    """All markers are covered for ten frames while the body swims on; the order must survive."""
    return _covered(BendingMotion(drift_m_per_s=0.1), (0, 1, 2), count, width_px)


def other_blue_things(count: int, width_px: int) -> Pictures:
    """A blue dot like a marker floats by, a blue cable lies in view, the middle marker is covered once."""
    for frame, seen in _covered(BendingMotion(), (1,), count, width_px):
        size = width_px / 1920
        x = (700 + 240 * frame.time_s * FRAME_RATE_HZ / count) * size
        cv2.circle(frame.image, (int(x), int(330 * size)), round(12 * size), BLUE, cv2.FILLED, cv2.LINE_AA)
        cv2.rectangle(
            frame.image,
            (int(200 * size), int(900 * size)),
            (int(800 * size), int(916 * size)),
            BLUE,
            cv2.FILLED,
        )
        yield frame, seen


def head_on_the_right(count: int, width_px: int) -> Pictures:
    """The camera is mounted the other way round: head and tail swap sides of the picture."""
    return _covered(BendingMotion(), (), count, width_px, roll_rad=np.pi)


def leaving_the_picture(count: int, width_px: int) -> Pictures:
    """The body swims out over the left edge, head first, and comes back."""
    bending = BendingMotion()
    times = np.linspace(0.0, count / FRAME_RATE_HZ, count + 1)
    away = 0.09 * np.sin(np.pi * times / times[-1]) ** 2
    lines = np.array([bending.centre_line(t) - [shift, 0.0] for t, shift in zip(times, away, strict=True)])
    renderer = Renderer(SampledMotion(times, lines), _view(width_px), degradation=CAMERA)
    clear = 2.5 * renderer.shape.marker_radius_m * renderer.view.pixels_per_m
    for frame in renderer.frames(FRAME_RATE_HZ, count):
        yield frame, bool(frame.markers_px[:, 0].min() > clear)


CASES: dict[str, Callable[[int, int], Pictures]] = {
    "marker hidden for 10 frames": marker_hidden,
    "all hidden for 10 frames, swimming": all_hidden_while_swimming,
    "other blue things, marker hidden": other_blue_things,
    "head on the right": head_on_the_right,
    "leaving the image and back": leaving_the_picture,
}


def measure_robustness(case: str, count: int, width_px: int = 1920) -> Robustness:
    """Track a case with default settings and compare with the truth."""
    shown = list(CASES[case](count, width_px))
    run = track_frames(
        (Frame(index, frame.time_s, image=frame.image) for index, (frame, _) in enumerate(shown)),
        BendingTracker(),
    )
    unseen = false_angles = late = 0
    for (frame, seen), valid, positions in zip(shown, run.valid, run.markers_px, strict=True):
        wrong = valid and np.abs(positions - frame.markers_px).max() > WRONG_PX
        unseen += not seen
        # A marker at the picture's edge may or may not still be measured; what counts is that it is right.
        hidden = not seen and case != "leaving the image and back"
        false_angles += bool(valid and (hidden or wrong))
        late += bool(seen and not valid)
    return Robustness(case, count, unseen, false_angles, late)


def _covered(
    motion: BendingMotion, markers: tuple[int, ...], count: int, width_px: int, roll_rad: float = 0.0
) -> Pictures:
    renderer = Renderer(motion, _view(width_px, roll_rad), degradation=CAMERA)
    for index in range(count):
        covered = bool(markers) and HIDDEN_FROM <= index < HIDDEN_FROM + HIDDEN_FRAMES
        yield renderer.frame(index / FRAME_RATE_HZ, index, markers if covered else ()), not covered


def _view(width_px: int, roll_rad: float = 0.0) -> CameraView:
    return CameraView(width_px, width_px * 9 // 16, 6000.0 * width_px / 1920, roll_rad=roll_rad)
