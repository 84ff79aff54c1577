"""An additional stress at Gauss points: what it changes with the contraction of the muscles."""

import numpy as np
import pytest
from hasel_sim.build import Builder
from hasel_sim.mechanics.motion import DriveState, Motion
from hasel_sim.mechanics.strained import Strained
from hasel_sim.model import load_model


@pytest.mark.parametrize(("effect", "contracts"), [("strain_softening", False), ("force_length", True)])
def test_one_that_does_not_ask_for_the_contraction_is_not_asked_twice(effect, contracts):
    """After its moduli were found, it is known not to change with it; before, it is tried, to the same end."""
    model = load_model("swimmer").with_effects(effect)
    typical = {f"{effect}.{p.name}": p.typical for p in model.effects[0].parameters}
    system = Builder(model.with_values(typical)).system()
    (law,) = system.stresses
    bent = 1.01 * system.nodes[..., None]
    at = Strained(system.solid, Motion(bent, np.zeros_like(bent), np.zeros_like(bent)))
    drive = DriveState.single(np.zeros(2), np.array([0.05, 0.0]), 0.0)
    tried = law.contraction_slopes(at, drive)
    assert bool(np.abs(tried).any()) is contracts
    law.moduli(at, drive)
    known = law.contraction_slopes(at, drive)
    if contracts:
        assert known == pytest.approx(tried)
    else:
        assert len(known) == 0
