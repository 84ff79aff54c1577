# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Where a fit begins."""

import numpy as np
import pytest
from hasel_sim.effects.registry import catalogue
from hasel_sysid.candidates import Candidate
from hasel_sysid.estimation import fit_baseline
from hasel_sysid.estimation.starts import screen, starts
from hasel_sysid.testing.made_up_world import MadeUpWorld


def candidate(name: str) -> Candidate:
    """An effect of the catalogue."""
    return Candidate(name, catalogue()[name].parameters, catalogue()[name])


def sizes(name: str) -> list[float]:
    """All that the first parameter begins at."""
    first = next(iter(candidate(name).sizes))
    return sorted({start.values[first] for start in starts(candidate(name))})


def test_a_typical_size_comes_first():
    """A slew limit at 2e-5 s/V; an asymmetry of either sign at its typical one."""
    first = starts(candidate("current_limit"))[0]
    assert first.typical and first.values == {"current_limit.inverse_rate": 2e-5}
    (asymmetry,) = catalogue()["muscle_asymmetry"].parameters
    assert next(iter(starts(candidate("muscle_asymmetry"))[0].values.values())) == asymmetry.typical


def test_a_place_is_begun_from_everywhere_and_a_time_from_both_sides():
    """Derivatives lead from one relaxation time to another, and not past a place that hardly moves."""
    typical = [s for s in starts(candidate("tether")) if s.typical]
    assert {s.values["tether.position"] for s in typical} >= {0.005, 0.05, 0.094, 0.15}
    creep = [s for s in starts(candidate("viscoelastic_creep")) if s.typical]
    times = {s.values["viscoelastic_creep.relaxation_time"] for s in creep}
    assert min(times) < 0.3 < max(times)


def test_a_mass_is_begun_over_the_decades_of_its_range():
    """What is far from the truth by typical sizes may be a third of a decade from one of them."""
    masses = sizes("payload")
    assert masses[0] == pytest.approx(0.001) and 3.0 < masses[-1] <= 10.0
    assert np.diff(np.log10(masses)) == pytest.approx(0.5)


def test_a_scale_is_begun_below_and_above_one_and_a_signed_size_to_either_side():
    """A ratio evenly in its logarithm; no size is at its null."""
    scales, signed = sizes("soft_modulus"), sizes("pre_bend")
    assert min(scales) < 0.5 and max(scales) > 2.0 and 1.0 not in scales
    assert min(signed) < 0.0 < max(signed) and 0.0 not in signed


def test_a_start_goes_where_it_explains_as_far_as_proportion_is_believed():
    """A tenth to twice its typical size; to the other side only what may be there."""
    damping = starts(candidate("material_damping"))[0]
    (typical,) = damping.values.values()
    sizes = [next(iter(damping.where_it_explains(a).values.values())) for a in (0.01, 0.5, 5.0, -1.0)]
    assert sizes == pytest.approx([0.1 * typical, 0.5 * typical, 2.0 * typical, typical])
    bend = starts(candidate("pre_bend"))[0]
    (curvature,) = bend.values.values()
    assert list(bend.where_it_explains(-0.5).values.values()) == pytest.approx([-0.5 * curvature])


@pytest.mark.parametrize("name", catalogue())
def test_no_start_leaves_a_range(name):
    """Whatever its size, time or place."""
    one = candidate(name)
    ranges = {one.path(p): p for p in one.parameters}
    for start in starts(one):
        assert all(ranges[path].lower <= value <= ranges[path].upper for path, value in start.values.items())


def test_a_fit_begins_at_another_size_as_it_is():
    """First order about a model without it tells little of how much of a large size is best."""
    world = MadeUpWorld(4)
    problem = world.measured(world.with_typical("payload"))
    about = fit_baseline(problem, world.model).evaluation
    others = [start for start in starts(candidate("payload")) if not start.typical]
    for one in screen(problem, about, others):
        assert one.values() == one.start.values


@pytest.mark.parametrize("times", [0.5, 1.8])
def test_screening_foretells_the_size(times):
    """In a world in which sizes act in proportion: one simulation without derivatives tells size and squares."""
    world = MadeUpWorld(4)
    truth = world.with_typical("payload")
    problem = world.measured(truth.with_values({"payload.mass": times * 0.01}))
    about = fit_baseline(problem, world.model).evaluation
    seen = {
        one.start.candidate.name: one
        for name in ("payload", "linear_drag")
        for one in screen(problem, about, [starts(candidate(name))[0]])
    }
    assert seen["payload"].amount == pytest.approx(times, rel=0.03)
    assert seen["payload"].values() == {"payload.mass": pytest.approx(times * 0.01, rel=0.03)}
    assert seen["payload"].predicted < 0.3 * seen["linear_drag"].predicted
