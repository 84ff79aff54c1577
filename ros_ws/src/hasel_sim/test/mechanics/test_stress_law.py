"""An additional stress at Gauss points: what it changes with the contraction of the muscles."""

import numpy as np
import pytest
from hasel_sim.build import Builder
from hasel_sim.mechanics.motion import DriveState, Motion
from hasel_sim.mechanics.strained import Strained
from hasel_sim.model import load_model


@pytest.mark.parametrize(("effect", "contracts"), [("strain_softening", False), ("force_length", True)])
def test_one_that_does_not_ask_for_the_contraction_is_not_differentiated_by_it(effect, contracts):
    """Its law says so; of one that does, the derivative is that of its stress."""
    model = load_model("swimmer").with_effects(effect)
    typical = {f"{effect}.{p.name}": p.typical for p in model.effects[0].parameters}
    system = Builder(model.with_values(typical)).system()
    (law,) = system.stresses
    bent = 1.01 * system.nodes[..., None]
    at = Strained(system.solid, Motion(bent, np.zeros_like(bent), np.zeros_like(bent)))
    more, drive, less = (
        DriveState.single(np.zeros(2), np.array([0.05 + step, 0.0]), 0.0) for step in (1e-4, 0.0, -1e-4)
    )
    slopes = law.contraction_slopes(at, drive)
    change = (law.stress(at, more) - law.stress(at, less)) / 2e-4
    assert bool(np.abs(change).any()) is contracts
    assert len(slopes) == (2 if contracts else 0)
    if contracts:
        assert slopes[0] == pytest.approx(change, rel=1e-6)
