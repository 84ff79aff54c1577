# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The angle of the simulated body at each frame, and its noise, of the strength and memory asked for."""

import numpy as np
import pytest
from hasel_bringup.virtual.seen_swimmer import CameraNoise, SeenBody
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.model import Model, load_model
from hasel_sim.run import Run
from hasel_sim.simulate import simulate

FIRST_NS = 1_700_000_000_000_000_000
FRAME_NS = round(1e9 / 120)


@pytest.fixture
def model() -> Model:
    """A swimmer at one voltage."""
    return load_model("swimmer").with_levels([4500.0]).with_values({"amplitude_4500": 0.02})


def states(count: int = 60) -> list[tuple[int, np.ndarray]]:
    """States some 95 times a second, not evenly: one muscle, then the other."""
    rng = np.random.default_rng(4)
    stamps = FIRST_NS + np.concatenate([[0], np.cumsum(rng.integers(8_000_000, 13_000_000, count - 1))])
    return [
        (int(stamp), np.array([4500.0, 0.0] if n < 30 else [0.0, 4500.0])) for n, stamp in enumerate(stamps)
    ]


def seen(body: SeenBody, taken) -> list:
    """All angles that some states lead to."""
    return [angle for stamp, voltage in taken for angle in body.state(stamp, voltage)[0]]


def test_frames_keep_their_own_rate(model):
    """At 120 Hz from the first state to the last, whatever the states' stamps."""
    taken = states()
    stamps = [angle.stamp_ns for angle in seen(SeenBody(model, 120.0), taken)]
    assert stamps == list(range(FIRST_NS, taken[-1][0] + 1, FRAME_NS))


def test_the_angles_are_those_of_the_whole_run(model):
    """What `simulate` finds at the frames under the same states, to a hundredth of the motion."""
    taken = states()
    angles = seen(SeenBody(model, 120.0), taken)
    schedule = DriveSchedule(
        np.array([stamp - FIRST_NS for stamp, _ in taken]) * 1e-9, np.array([voltage for _, voltage in taken])
    )
    times = np.array([angle.stamp_ns - FIRST_NS for angle in angles]) * 1e-9
    expected = simulate(model, Run("seen", times, schedule)).sin_theta
    difference = np.array([angle.sin_theta for angle in angles]) - expected
    assert np.abs(difference).max() < 0.01 * np.ptp(expected)


def test_a_state_that_comes_twice_or_late_changes_nothing(model):
    """As a simulator that hears it."""
    disturbed = states()
    disturbed.insert(12, disturbed[4])
    disturbed.insert(20, disturbed[19])
    assert seen(SeenBody(model, 120.0), disturbed) == seen(SeenBody(model, 120.0), states())


def test_after_a_jump_of_the_stamps_a_new_run_begins(model):
    """Its first frame is its first state, and nothing is made up for the time between."""
    body = SeenBody(model, 120.0)
    seen(body, states())
    later_ns = FIRST_NS + 60_000_000_000
    angles, sentence = body.state(later_ns, np.zeros(2))
    assert [angle.stamp_ns for angle in angles] == [later_ns]
    assert "new run" in sentence
    angles, _ = body.state(later_ns + 10_000_000, np.zeros(2))
    assert [angle.stamp_ns for angle in angles] == [later_ns + FRAME_NS]


def test_an_effect_that_looks_ahead_delays_the_frames_only(model):
    """A camera whose clock is early answers later, with every frame."""
    early = model.with_effects("camera_latency").with_values(
        {**model.values, "camera_latency.latency": -0.02}
    )
    stamps = [angle.stamp_ns for angle in seen(SeenBody(early, 120.0), states())]
    assert stamps[:20] == [FIRST_NS + n * FRAME_NS for n in range(20)]


@pytest.mark.parametrize(
    ("white", "coloured", "correlation"), [(0.002, 0.0, 0.9), (0.0, 0.003, 0.9), (0.002, 0.003, 0.8)]
)
def test_strength_and_memory(white, coloured, correlation):
    """Variance is the sum of both parts', covariance of neighbours that of the coloured part."""
    noise = CameraNoise(white, coloured, correlation, seed=3)
    series = np.array([noise.next() for _ in range(200_000)])
    assert series.var() == pytest.approx(white**2 + coloured**2, rel=0.03)
    assert np.mean(series[1:] * series[:-1]) == pytest.approx(correlation * coloured**2, rel=0.04, abs=3e-8)


def test_the_seed_decides():
    """The same seed repeats the noise, another does not."""
    first, same, other = (CameraNoise(1.0, 1.0, 0.5, seed) for seed in (1, 1, 2))
    values = [noise.next() for noise in (first, same, other)]
    assert values[0] == values[1] != values[2]
