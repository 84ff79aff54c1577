# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What a picture leaves open is settled by what the user says: --roi, --at, --head."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hasel_tracker.errors import TrackerError
from hasel_tracker.offline.tracked_run import TrackedRun, track_frames
from hasel_tracker.sources.frame import Frame
from hasel_tracker.tracking.bending_tracker import BendingTracker
from hasel_tracker_lab.scenes.lab_scene import LabFrame
from hasel_tracker_lab.scenes.scene_catalogue import ADVERSARIAL

SCENES = {case.name: case for case in ADVERSARIAL}
MARGIN_PX = 40


@cache
def shown(name: str, seed: int = 0, count: int = 10) -> list[LabFrame]:
    """The first frames of a scene."""
    return list(SCENES[name].scene(seed).frames(count))


def followed(pictures: list[LabFrame], **told: object) -> tuple[TrackedRun, str]:
    """What is found with what the user says, and the tracker's note."""
    tracker = BendingTracker(**told)
    frames = [Frame(number, each.time_s, image=each.image) for number, each in enumerate(pictures)]
    return track_frames(frames, tracker), tracker.note


def region_about(pictures: list[LabFrame]) -> tuple[int, int, int, int]:
    """X, Y, width and height of what the first swimmer's dots go through, and some more."""
    dots = np.array([each.dots_px for each in pictures])
    low = np.floor(dots.min(axis=(0, 1))).astype(int) - MARGIN_PX
    size = np.ceil(dots.max(axis=(0, 1))).astype(int) + MARGIN_PX - low
    return tuple(int(value) for value in (*low, *size))


@pytest.mark.parametrize("told", ["roi", "start_at"])
@pytest.mark.parametrize("seed", [0, 3])
def test_one_of_two_swimmers(told, seed):
    """Two swimmers give no angle and a sentence that says what to do; done so, every frame has the right one."""
    pictures = shown("two swimmers", seed)
    run, note = followed(pictures)
    assert not run.valid.any()
    assert "more than one row of three dots" in note
    assert "--at" in note
    assert "--roi" in note
    value = region_about(pictures) if told == "roi" else pictures[0].dots_px
    run, _ = followed(pictures, **{told: value})
    assert run.valid.all()
    assert np.abs(run.sin_theta - [each.sin_theta for each in pictures]).max() < 2e-3


def test_a_tight_region_makes_no_head():
    """What lies beyond the region, or the picture's edge, is no contrast: halves that look alike stay so."""
    pictures = shown("body without taper")
    run, note = followed(pictures, roi=region_about(pictures))
    assert not run.valid.any()
    assert "--head" in note
    settings = replace(SCENES["body without taper"].settings, head="right")
    run, _ = followed(pictures, roi=region_about(pictures), settings=settings)
    assert np.abs(run.sin_theta - [each.sin_theta for each in pictures]).max() < 2e-3


@pytest.mark.parametrize("strength", [60, 80])
def test_pointing_at_what_a_reflection_lies_over_is_refused(strength):
    """Where a strong reflection covers a dot, what is seen there has its middle elsewhere, and the user is told so."""
    pictures = shown(f"reflection over the dots, {strength} %", count=2)
    assert not followed(pictures)[0].valid.any()
    with pytest.raises(
        TrackerError, match=r"px away, at .*: point at a dot's middle, in a frame in which nothing"
    ):
        followed(pictures, start_at=pictures[0].dots_px)
