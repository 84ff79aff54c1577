# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Where the markers are at each exposure."""

import numpy as np
import pytest
from hasel_bringup.virtual.seen_swimmer import FilmedSwimmer
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


def one_by_one(swimmer, taken) -> list:
    """Exposures as the states come."""
    return [exposure for stamp, voltage in taken for exposure in swimmer.state(stamp, voltage)]


def film(swimmer, taken) -> list:
    """Exposures of the whole run."""
    return swimmer.film(taken)


def test_a_run_filmed_as_a_whole_shows_what_was_seen_step_by_step(swimmer):
    """The same stamps, and the markers in the same places to a hundredth of their motion."""
    seen = one_by_one(swimmer, states())
    swimmer.put_back()
    filmed = film(swimmer, states())
    assert [each.stamp_ns for each in filmed] == [each.stamp_ns for each in seen]
    difference = np.array([a.markers - b.markers for a, b in zip(filmed, seen, strict=True)])
    motion = np.array([each.markers for each in filmed])
    assert np.abs(difference).max() < 0.01 * np.ptp(motion[..., 1])


def places(exposures) -> list:
    """Stamps and markers."""
    return [(each.stamp_ns, each.markers.tolist()) for each in exposures]


@pytest.mark.parametrize("by", [film, one_by_one])
def test_states_that_come_twice_or_late_are_left_out(swimmer, by):
    """Their voltage too: an old one does not come into force again."""
    expected = places(by(swimmer, states()))
    disturbed = states()
    disturbed.insert(12, disturbed[4])
    disturbed.insert(20, disturbed[19])
    swimmer.put_back()
    assert places(by(swimmer, disturbed)) == expected


def test_a_run_without_states_has_no_pictures(swimmer):
    """One state says where the run begins, and no more."""
    assert swimmer.film([]) == []
    assert swimmer.film(states()[:1]) == []
