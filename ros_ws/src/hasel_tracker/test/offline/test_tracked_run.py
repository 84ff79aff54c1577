# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What a tracked run says of itself, corrections by hand, and the cut from the first movement on."""

import numpy as np
import pytest
from hasel_tracker.errors import TrackerError
from hasel_tracker.offline.tracked_run import (
    TrackedRun,
    cut_to_periods,
    first_movement_s,
    read_fixes,
    track_frames,
)
from hasel_tracker.sources.frame import Frame
from hasel_tracker.tracking.bending_tracker import BendingTracker

TIMES = np.arange(360) / 120.0


def run_of(sin_theta: list[float]) -> TrackedRun:
    """Some frames at 120 per second."""
    sines = np.array(sin_theta)
    count = len(sines)
    return TrackedRun(
        np.arange(count) / 120.0, sines, np.arcsin(sines), np.zeros((count, 3, 2)), np.ones((count, 3))
    )


def test_one_frame_has_no_rate():
    """A run of one frame says so rather than "nan frames/s"; one without an angle has no range of angles."""
    assert str(run_of([0.1])) == "1 frame, 0 without an angle; sin θ from +0.1000 to +0.1000."
    assert str(run_of([np.nan])) == "1 frame, an angle in none of them."
    assert str(run_of([0.1, np.nan, -0.2])).startswith(
        "3 frames at 120 frames/s, 1 without an angle; sin θ from -0.2"
    )


def test_a_fix_turns_a_swimmer_round(frames, tmp_path):
    """From the frame that a fix names on, head and tail are where the person says, without doubt."""
    points = frames[5].markers_px[::-1].round().astype(int).tolist()
    path = tmp_path / "fix.yaml"
    path.write_text(f"- {{frame: 5, at: {points}}}\n")
    pictures = [Frame(index, frame.time_s, image=frame.image) for index, frame in enumerate(frames[:10])]
    run = track_frames(pictures, BendingTracker(), placed=read_fixes(path))
    assert run.valid.all()
    truth = np.array([frame.markers_px for frame in frames[:10]])
    assert np.abs(run.markers_px[:5] - truth[:5]).max() < 0.2
    assert np.abs(run.markers_px[5:] - truth[5:, ::-1]).max() < 0.2


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{}", "are not a list"),
        ("- {frame: 3}", "expected a frame and its markers"),
        ("- {frame: -1, at: [[1, 2]]}", "expected a frame and its markers"),
        ("- [", "cannot be read"),
    ],
)
def test_unreadable_fixes_are_explained(tmp_path, text, message):
    """What is wrong with a file of corrections is one sentence with an example."""
    (tmp_path / "fix.yaml").write_text(text)
    with pytest.raises(TrackerError, match=message):
        read_fixes(tmp_path / "fix.yaml")


def test_a_fix_beside_the_dots_or_the_video_is_refused(frames):
    """A point where there is no dot, or a frame that the video does not have, is named."""
    pictures = [Frame(index, frame.time_s, image=frame.image) for index, frame in enumerate(frames[:3])]
    with pytest.raises(TrackerError, match="No dot of marker colour is at 10,20"):
        track_frames(pictures, BendingTracker(), placed={0: np.array([[10, 20], [300, 100], [500, 100]])})
    with pytest.raises(TrackerError, match="for frame 9, but the source has 3 frames"):
        track_frames(pictures, BendingTracker(), placed={9: frames[0].markers_px})


def beat(start_s: float, noise: float = 0.0, frequency_hz: float = 2.0) -> np.ndarray:
    """sin θ of a body that rests at 0.05 and beats from `start_s` on."""
    active = np.maximum(TIMES - start_s, 0.0)
    return (
        0.05
        + 0.3 * np.sin(2.0 * np.pi * frequency_hz * active)
        + noise * np.random.default_rng(1).normal(size=360)
    )


def beat_of(sin_theta: np.ndarray) -> TrackedRun:
    """A run with this angle."""
    return TrackedRun(TIMES, sin_theta, np.arcsin(sin_theta), np.zeros((360, 3, 2)), np.ones((360, 3)))


@pytest.mark.parametrize("start_s", [0.1, 0.4, 1.0])
@pytest.mark.parametrize("noise", [0.0, 5e-4])
def test_first_movement_to_a_frame(start_s, noise):
    """The first movement is found to one frame, with and without noise."""
    assert first_movement_s(TIMES, beat(start_s, noise)) == pytest.approx(start_s, abs=1.01 / 120.0)


def test_lost_frames_and_a_single_outlier_are_passed_over():
    """Frames without an angle, or one wrong one, are not taken for movement."""
    sin_theta = beat(0.5)
    sin_theta[20:25] = np.nan
    sin_theta[40] = 0.4
    assert first_movement_s(TIMES, sin_theta) == pytest.approx(0.5, abs=1.01 / 120.0)


def test_cut_keeps_two_periods():
    """The seed's cut: from the first movement, two periods of the drive."""
    cut = cut_to_periods(beat_of(beat(0.4)), 2.0)
    assert len(cut.time_s) == 120
    assert cut.time_s[0] == pytest.approx(0.4, abs=1.01 / 120.0)


@pytest.mark.parametrize(
    ("sin_theta", "frequency_hz", "message"),
    [
        (beat(9.0), 2.0, "never moves more than"),
        (beat(0.0), 2.0, "moves within the first 6 frames"),
        (beat(1.0), 0.5, "less than 2 periods of 0.5 Hz"),
        (beat(1.0), 0.0, "expected positive numbers"),
    ],
)
def test_impossible_cuts_are_explained(sin_theta, frequency_hz, message):
    """No movement, movement from the start, too short a run: each is said."""
    with pytest.raises(TrackerError, match=message):
        cut_to_periods(beat_of(sin_theta), frequency_hz)
