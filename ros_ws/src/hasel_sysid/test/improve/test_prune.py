"""Effects that a later one has made superfluous."""

from types import SimpleNamespace

import pytest
from hasel_sim.errors import SimulationError
from hasel_sysid.improve import prune
from hasel_sysid.improve.prune import pruned


class Model:
    """Only the names of its effects matter here."""

    def __init__(self, *effects):
        self.effects = [SimpleNamespace(id=name) for name in effects]

    @property
    def names(self):
        """In order."""
        return [effect.id for effect in self.effects]

    def without_effects(self, name):
        """One less."""
        return Model(*(effect for effect in self.names if effect != name))


@pytest.fixture
def fits(monkeypatch):
    """Fits whose sum of squares is looked up by the effects in the model."""
    squares = {}

    def fit(_problem, model, **_options):
        found = squares[tuple(model.names)]
        if found is None:
            raise SimulationError("too soft to stand")
        return SimpleNamespace(model=model, evaluation=SimpleNamespace(sum_of_squares=found))

    def begin(table):
        squares.update(table)
        return fit(None, Model(*max(table, key=len)))

    monkeypatch.setattr(prune, "fit_least_squares", fit)
    return begin


@pytest.mark.parametrize(
    ("without_the_first", "kept"),
    [(1.02, ["quadratic"]), (1.5, ["linear", "quadratic"]), (None, ["linear", "quadratic"])],
)
def test_what_stood_in_for_another_effect_is_dropped(fits, without_the_first, kept):
    """A trifle goes; what is needed stays, and so does what the body cannot be simulated without."""
    fit = fits({("linear", "quadratic"): 1.0, ("quadratic",): without_the_first})
    assert pruned(None, fit, ["linear"]).model.names == kept


def test_an_effect_that_was_exchanged_meanwhile_is_not_looked_for(fits):
    """Only effects that are still in the model."""
    fit = fits({("creep", "modulus"): 1.0})
    assert pruned(None, fit, ["drag"]) is fit
