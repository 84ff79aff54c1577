"""Which sizes over the decades of a range are tried, on made-up responses to the size."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hasel_sim.effects.registry import catalogue
from hasel_sim.model import load_model
from hasel_sysid.candidates import Start, decade_starts, starts
from hasel_sysid.diagnosis.glimpse import Glimpse
from hasel_sysid.diagnosis.trial import Trial
from hasel_sysid.selection.decade_trials import Decades

SHAPE = np.sin(np.linspace(0.0, 9.0, 200))
UNEXPLAINED = 2.0 * SHAPE
MOTION = 20.0 * SHAPE


def made(start: Start, name: str, response: Callable[[float], float]) -> Trial:
    """A trial of a body whose series is the response to the size, times a shape."""
    model = load_model("swimmer").with_effects(start.effect.id).with_values(start.values)
    value = start.values[name]
    slope = (response(value + 1e-6) - response(value - 1e-6)) / 2e-6
    residual = UNEXPLAINED - response(value) * SHAPE
    return Trial(start, model, (name,), (name,), residual, (slope * SHAPE)[:, None], {}, 0.0, 0.0)


def seen(start: Start, name: str, response: Callable[[float], float]) -> Glimpse:
    """The same without derivatives."""
    return Glimpse(start, UNEXPLAINED - response(start.values[name]) * SHAPE)


def sizes(effect_id: str, response: Callable[[float], float]) -> tuple[list[float], list[float]]:
    """Sizes that are tried at the ends, and those between them."""
    effect = catalogue()[effect_id]
    name = f"{effect_id}.{effect.parameters[0].name}"
    decades = Decades(effect, [made(starts(effect)[0], name, response)], UNEXPLAINED, MOTION)
    ends = decades.ends()
    between = decades.between([seen(start, name, response) for start in ends])
    return [s.values[name] for s in ends], [s.values[name] for s in between]


def every(effect_id: str) -> list[float]:
    """All sizes over the decades but the typical one."""
    effect = catalogue()[effect_id]
    name = f"{effect_id}.{effect.parameters[0].name}"
    known = starts(effect)[0].values[name]
    return [s.values[name] for s in decade_starts(effect) if s.values[name] != known]


def test_what_acts_in_proportion_is_tried_at_its_ends_only():
    """A signed effect on both sides, a one-sided one not towards nothing, where it is known what is left."""
    drift, drag = every("gain_drift"), every("linear_drag")
    assert sizes("gain_drift", lambda s: 10.0 * s) == ([drift[0], drift[-1]], [])
    assert sizes("linear_drag", lambda s: 0.3 * s) == ([drag[-1]], [])


def test_what_bends_is_tried_where_the_first_order_errs_by_much_of_what_is_left():
    """A square that at the end of the range is as large as what is left, and at a third of it a ninth."""
    drift = every("gain_drift")
    far = max(drift)
    ends, between = sizes("gain_drift", lambda s: 2.0 * (10.0 * s + (s / far) ** 2))
    assert set(ends) == {min(drift), far}
    assert between == [s for s in drift if s not in ends and (s / far) ** 2 > 0.15]


def test_a_one_sided_effect_that_saturates_is_tried_below_too():
    """From its typical size the first order does not lead back to what is left without it."""
    below = [s for s in every("linear_drag") if s < catalogue()["linear_drag"].parameters[0].typical]
    _, between = sizes("linear_drag", lambda s: 2.0 * np.tanh(2.0 * s))
    assert set(below) <= set(between)


def test_what_errs_by_much_of_the_motion_at_its_end_is_seen_everywhere():
    """A load that stops the body errs at a hundred times the size as at five times: its square says nothing between."""
    heavier = [mass for mass in every("payload") if mass > 0.01]
    ends, between = sizes("payload", lambda s: 8.0 * np.tanh(s / 0.05))
    assert ends == heavier[-1:]
    assert set(heavier[:-1]) <= set(between)


def test_beyond_an_end_that_could_not_be_simulated_all_sizes_are_tried():
    """Nothing is known there."""
    effect = catalogue()["gain_drift"]
    name = f"gain_drift.{effect.parameters[0].name}"
    decades = Decades(effect, [made(starts(effect)[0], name, lambda s: s)], UNEXPLAINED, MOTION)
    lower, upper = decades.ends()
    between = decades.between([seen(lower, name, lambda s: s)])
    left = [s.values[name] for s in between]
    assert left == [s for s in every("gain_drift") if 0.0 < s < upper.values[name]]


@pytest.mark.parametrize("effect", ["viscoelastic_creep", "gain_drift"])
def test_without_a_trial_beside_them_all_are_tried_at_once(effect):
    """Nothing foretells any of them."""
    assert len(Decades(catalogue()[effect], [], UNEXPLAINED, MOTION).ends()) == len(
        decade_starts(catalogue()[effect])
    )


def test_sizes_are_those_of_the_relaxation_time_that_promises_most():
    """There a trial foretells most of them."""
    effect = catalogue()["viscoelastic_creep"]
    name = "viscoelastic_creep.modulus_ratio"
    short, long = (made(start, name, lambda s: s) for start in starts(effect))
    time = "viscoelastic_creep.relaxation_time"
    for best, other in ((short, long), (long, short)):
        trials = [replace(best, promised=2.0), replace(other, promised=1.0)]
        decades = Decades(effect, trials, UNEXPLAINED, MOTION)
        assert {start.values[time] for start in decades.starts} == {best.start.values[time]}
        assert len(decades.ends()) == 1
