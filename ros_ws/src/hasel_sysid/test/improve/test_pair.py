"""Two effects at once."""

from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sim.errors import SimulationError
from hasel_sysid.improve import Stage
from hasel_sysid.improve import pair as module
from hasel_sysid.improve.pair import explaining_pair, promising_pairs

TIME = np.arange(600) / 120.0
FITTED = np.sin(2 * np.pi * TIME)[:, None]
DRAG, DELAY, CREEP = (np.sin(2 * np.pi * n * TIME) for n in (3, 5, 7))
LOOKS = {
    "drag": DRAG + 2.0 * FITTED[:, 0],
    "delay": DELAY,
    "latency": DELAY - 0.1 * CREEP,
    "creep": CREEP,
}
NOISE = 0.0024


def fit(error, model=()):
    """One with this mean error."""
    return SimpleNamespace(mean_absolute_error=error, model=model)


def stage(residual):
    """A baseline that leaves this residual; delay and latency look alike in it."""
    evaluation = SimpleNamespace(residual=residual, jacobian=FITTED)
    context = SimpleNamespace(
        fit=SimpleNamespace(evaluation=evaluation),
        signatures={name: SimpleNamespace(columns=looks[:, None]) for name, looks in LOOKS.items()},
        excess=float(residual @ residual),
    )
    found = SimpleNamespace(
        context=context, groups=[("delay", "latency")], noise=SimpleNamespace(mean_absolute=NOISE)
    )
    return Stage((), fit(0.02), None, found)


@pytest.fixture
def fits(monkeypatch):
    """Mean errors, by the two effects in the model; what is not listed cannot be simulated. Returns what was fitted."""
    errors, tried = {}, []

    def fitted(_problem, model, **_options):
        tried.append(set(model))
        if frozenset(model) not in errors:
            raise SimulationError("too soft to stand")
        return fit(errors[frozenset(model)], model)

    monkeypatch.setattr(module, "fit_least_squares", fitted)
    monkeypatch.setattr(module, "with_effect", lambda model, found, effect: (*model, effect))
    monkeypatch.setattr(module, "plausible", lambda finals, base: finals)
    return SimpleNamespace(errors=errors, tried=tried)


def test_pairs_are_ranked_by_what_they_promise_together():
    """Neither removes most of the error alone; twins make no pair, nor does what has nothing of the residual."""
    found = stage(1.0 * DRAG + 0.8 * DELAY + 0.1 * CREEP).diagnosis
    assert promising_pairs(found)[:2] == [("drag", "delay"), ("drag", "latency")]
    assert ("delay", "latency") not in promising_pairs(found)
    assert ("delay", "creep") not in promising_pairs(found)


def test_what_the_fitted_parameters_imitate_is_promised_by_nobody():
    """Their share of the residual is theirs."""
    assert promising_pairs(stage(FITTED[:, 0]).diagnosis) == []


def test_the_pair_that_explains_is_taken(fits):
    """Though another one promised a little more."""
    fits.errors.update({frozenset({"drag", "delay"}): 0.009, frozenset({"drag", "latency"}): 0.0025})
    assert set(explaining_pair(None, stage(DRAG + DELAY)).model) == {"drag", "latency"}


def test_a_pair_that_explains_only_in_part_is_not(fits):
    """A third of the error above the noise is left."""
    fits.errors.update({frozenset({"drag", "delay"}): 0.008, frozenset({"drag", "latency"}): 0.008})
    assert explaining_pair(None, stage(DRAG + DELAY)) is None
    assert len(fits.tried) == 2


def test_a_pair_with_an_implausible_member_is_not(fits, monkeypatch):
    """Whatever it explains."""
    monkeypatch.setattr(module, "plausible", lambda finals, base: {} if "drag" in finals else finals)
    fits.errors.update({frozenset({"drag", "delay"}): 0.0025})
    assert explaining_pair(None, stage(DRAG + DELAY)) is None


def test_a_pair_that_cannot_be_simulated_leaves_the_next_its_turn(fits):
    """The first is missing in the table."""
    fits.errors.update({frozenset({"drag", "latency"}): 0.0025})
    assert explaining_pair(None, stage(DRAG + DELAY)) is not None
