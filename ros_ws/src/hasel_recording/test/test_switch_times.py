# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import warnings
from dataclasses import replace

import numpy as np
import pytest
from hasel_recording import Recording, RecordingWarning
from hasel_recording.switch_times import with_placed_switches

RATE = 120


def box(frequency: float, duty: float = 0.5, periods: float = 4, rest: int = 12) -> Recording:
    """A run at rest for some frames, then upper and lower muscle in turn; duty: the upper one's share."""
    time_s = np.arange(rest + int(periods / frequency * RATE)) / RATE
    phase = np.mod((time_s - rest / RATE) * frequency + 1e-9, 1.0)
    upper, started = phase < duty, np.arange(len(time_s)) >= rest
    signal = 5500.0 * np.stack([upper & started, ~upper & started], axis=1)
    return Recording("run", time_s, np.zeros(len(time_s)), signal)


def without(recording: Recording, rows) -> Recording:
    """The run with some rows lost."""
    kept = np.setdiff1d(np.arange(len(recording.time_s)), rows)
    chosen = {name: getattr(recording, name)[kept] for name in ("time_s", "sin_theta", "drive_signal")}
    return replace(recording, **chosen)


def switches(recording: Recording) -> np.ndarray:
    """When the drive changes [s]."""
    time_s, values = recording.drive()
    return time_s[1:][np.any(np.diff(values, axis=0) != 0, axis=1)]


@pytest.mark.parametrize(("frequency", "duty"), [(2.0, 0.5), (3.5, 0.5), (0.7, 0.5), (2.0, 0.3)])
def test_lost_rows_do_not_move_a_switch(frequency, duty):
    """Three rows lost around any one of the later switches leave it where it was, to a frame's rounding."""
    run = box(frequency, duty)
    truth = switches(run)
    for switch in truth[3:-1]:
        row = round(switch * RATE)
        with pytest.warns(RecordingWarning, match="placed at .* by the drive's period of"):
            placed = with_placed_switches(without(run, [row - 1, row, row + 1]))
        np.testing.assert_allclose(switches(placed), truth, atol=1.01 / RATE)


def test_switches_that_lie_on_frames_are_placed_exactly():
    """At 2 Hz and 120 frames/s all switches lie on frames: the placed one too."""
    run = box(2.0)
    with pytest.warns(RecordingWarning):
        placed = with_placed_switches(without(run, [72, 73]))
    np.testing.assert_allclose(switches(placed), switches(run), atol=1e-9)


@pytest.mark.parametrize(("frequency", "duty"), [(1.1, 0.5), (1.8, 0.5), (2.3, 0.5), (1.7, 0.3)])
def test_switches_between_frames_are_placed_by_their_period(frequency, duty):
    """Rows tell of a switch up to a frame late; its period tells it to a third of a frame and is not biased."""
    run = box(frequency, duty, periods=6)
    instants = 12 / RATE + np.arange(6)[:, None] / frequency + [0.0, duty / frequency]
    late = switches(run) - instants.ravel()
    placed = with_placed_switches(run)
    off = switches(placed) - instants.ravel()
    assert late.max() > 0.6 / RATE
    assert np.abs(off).max() < 0.4 / RATE
    assert "placed there by its spacing of" in placed.understood[-1]


def test_a_drive_without_a_period_stays_as_it_was_recorded():
    """No spacing puts every switch after the row before it."""
    time_s = np.arange(400) / RATE
    on = np.isin(np.arange(400), np.r_[30:71, 130:201, 215:260])
    run = Recording("run", time_s, np.zeros(400), 5500.0 * np.stack([on, ~on], axis=1))
    assert with_placed_switches(run) is run


def test_rows_lost_elsewhere_say_nothing():
    """Where no switch falls into a gap nothing is changed or said."""
    run = without(box(2.0), [80, 81, 82])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert with_placed_switches(run) is run


def test_a_drive_that_does_not_recur_stays_and_is_said():
    """A single step in a gap stays at the row after it, with what would help."""
    run = box(0.1, periods=0.1)
    with pytest.warns(RecordingWarning, match=r"taken to switch at 0.125 s: give its own file with --drive"):
        placed = with_placed_switches(without(run, [11, 12, 13, 14]))
    assert switches(placed) == pytest.approx([0.125])


def test_a_waveform_is_left_alone():
    """A sine changes at every row: there is no switch to place."""
    run = box(2.0)
    wave = replace(run, drive_signal=np.abs(np.sin(12 * run.time_s))[:, None] * [5000.0, 0.0])
    wave = without(wave, [50, 51])
    assert with_placed_switches(wave) is wave
