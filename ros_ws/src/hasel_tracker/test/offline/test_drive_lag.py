# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The lag between video and drive, on a body whose dynamics the estimator does not know."""

import numpy as np
import pytest
from hasel_tracker.errors import TrackerError
from hasel_tracker.offline.drive_lag import LagEstimate, estimate_lag

RATE_HZ, STEP_S = 120.0, 1.0 / 2400.0


def voltage(
    time_s: np.ndarray, kind: str, rest_s: float, offset: float, frequency_hz: float = 2.0
) -> np.ndarray:
    """Upper and lower voltage (n, 2) [V] of a box or sine drive that starts after a rest."""
    phase = (time_s - rest_s) * frequency_hz
    if kind == "box":
        wave = np.where(phase % 1.0 < 0.5, 1.0, -1.0)
    else:
        wave = np.sin(2.0 * np.pi * phase)
    wave = np.where(time_s < rest_s, 0.0, wave)
    return 3000.0 * np.column_stack([np.maximum(wave, 0.0), np.maximum(-wave, 0.0)]) + offset


def answer(pull: np.ndarray, frequency_hz: float, damping: float, slope_per_s: float) -> np.ndarray:
    """A muscle of limited rate that pulls at a mass on a spring, by small steps."""
    omega, contraction, place, speed = 2.0 * np.pi * frequency_hz, 0.0, 0.0, 0.0
    largest, answers = 0.12 * slope_per_s * STEP_S, np.empty(len(pull))
    for index, wanted in enumerate(0.12 * pull):
        contraction += min(max(wanted - contraction, -largest), largest)
        speed += (omega**2 * (contraction - place) - 2.0 * damping * omega * speed) * STEP_S
        place += speed * STEP_S
        answers[index] = place
    return answers


def found(
    lag_s: float, kind: str = "box", rest_s: float = 0.3, rock: float = 0.0, creep: float = 0.0, offset: float = 0.0,
    noise: float = 5e-4, body: tuple[float, float, float] = (5.0, 0.25, 6.0), frequency_hz: float = 2.0,
) -> LagEstimate:  # fmt: skip
    """The lag of three seconds of video and drive."""
    fine = np.arange(0.0, 4.5, STEP_S)
    volts = voltage(fine, kind, rest_s, 0.0, frequency_hz)
    answered = answer((volts[:, 0] - volts[:, 1]) / 3000.0, *body)
    times = np.arange(360) / RATE_HZ
    angle = np.interp(times - lag_s, fine, answered, left=0.0)
    angle += rock * np.sin(2.0 * np.pi * 0.7 * times) + creep * times
    angle += np.random.default_rng(2).normal(0.0, noise, len(times))
    drive_s = np.arange(300) / 100.0
    return estimate_lag(times, angle, drive_s, voltage(drive_s, kind, rest_s, offset, frequency_hz), 3.0)


CASES = {
    "no lag": (0.0, {}),
    "video first": (0.213, {}),
    "long before": (1.2, {}),
    "rocking by 0.003 at rest": (0.213, {"rock": 0.003}),
    "rocking by 0.007 at rest": (0.213, {"rock": 0.007}),
    "creeping by 0.003 a second": (0.213, {"creep": 0.003}),
    "0.1 V on an idle drive": (0.1, {"offset": 0.1}),
    "noisy": (0.05, {"noise": 5e-3}),
    "slow, hardly damped body": (0.05, {"body": (2.0, 0.1, 6.0)}),
    "stiff body": (0.05, {"body": (15.0, 0.6, 6.0)}),
    "slow muscle": (0.05, {"body": (5.0, 0.25, 2.0)}),
    "sine at 3.5 Hz": (0.05, {"kind": "sine", "frequency_hz": 3.5}),
}


@pytest.mark.parametrize(("lag_s", "more"), CASES.values(), ids=CASES)
def test_lag_is_within_its_interval(lag_s, more):
    """Whatever the body, its rocking or the drive's offset: the truth is in the interval, which is under 50 ms."""
    estimate = found(lag_s, **more)
    assert estimate.lag_s == pytest.approx(lag_s, abs=estimate.uncertainty_s)
    assert estimate.uncertainty_s < 0.05


def test_a_steady_beat_is_refused():
    """A video from the middle of a steady beat fits a period earlier or later as well, and is said to."""
    with pytest.raises(TrackerError, match="not determined"):
        found(-1.0, rest_s=0.0)


def test_an_angle_that_does_not_answer_is_refused():
    """Noise, whatever the drive, has no lag."""
    with pytest.raises(TrackerError, match=r"foretells nothing|not seen at rest"):
        found(0.1, noise=0.3)


@pytest.mark.parametrize(("level", "message"), [(0.0, "0 V throughout"), (3000.0, "never changes")])
def test_a_drive_that_never_changes_is_refused(level, message):
    """A drive of one level throughout has nothing to go by."""
    times = np.arange(200) / 100.0
    with pytest.raises(TrackerError, match=message):
        estimate_lag(times, np.sin(times), times, np.column_stack([np.full(200, level), np.zeros(200)]), 2.0)
