"""Tests for hasel_bringup.virtual_camera.filmed_swimmer."""

import numpy as np
import pytest
from hasel_bringup.virtual_camera.filmed_swimmer import FilmedSwimmer
from hasel_sim.model import load_model

PERIOD_NS = 10_000_000
FIRST_NS = 1_700_000_000_000_000_000


def states(count: int = 40) -> list[tuple[int, np.ndarray]]:
    """The supply's states at 100 Hz: at rest, then one muscle, then the other."""
    upper, lower = np.array([4500.0, 0.0]), np.array([0.0, 4500.0])
    voltages = [np.zeros(2)] * 5 + [upper] * 15 + [lower] * (count - 20)
    return [(FIRST_NS + n * PERIOD_NS, voltage) for n, voltage in enumerate(voltages)]


@pytest.fixture
def swimmer() -> FilmedSwimmer:
    """A swimmer in clear water."""
    model = load_model("swimmer").with_levels([4500.0])
    model = model.with_values({"amplitude_4500": 0.02})
    return FilmedSwimmer(model, 120.0, 0.0, np.random.default_rng(0))


def test_a_run_filmed_as_a_whole_shows_what_was_seen_step_by_step(swimmer):
    """The same stamps, and the markers in the same places to a hundredth of their motion."""
    one_by_one = [exposure for stamp, voltage in states() for exposure in swimmer.state(stamp, voltage)]
    swimmer.put_back()
    filmed = swimmer.film(states())
    assert [each.stamp_ns for each in filmed] == [each.stamp_ns for each in one_by_one]
    difference = np.array([a.markers - b.markers for a, b in zip(filmed, one_by_one, strict=True)])
    motion = np.array([each.markers for each in filmed])
    assert np.abs(difference).max() < 0.01 * np.ptp(motion[..., 1])


def test_states_that_come_twice_or_late_are_left_out(swimmer):
    """As when they are taken one by one."""
    expected = swimmer.film(states())
    disturbed = states()
    disturbed.insert(12, disturbed[4])
    disturbed.insert(20, disturbed[19])
    assert [each.markers.tolist() for each in swimmer.film(disturbed)] == [
        e.markers.tolist() for e in expected
    ]


def test_a_run_without_states_has_no_pictures(swimmer):
    """One state says where the run begins, and no more."""
    assert swimmer.film([]) == []
    assert swimmer.film(states()[:1]) == []
