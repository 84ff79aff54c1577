# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Slow creep."""

import numpy as np
import pytest
from hasel_sim.run import Run
from hasel_sim.simulate import simulate


def test_it_is_a_second_prony_term(cantilever):
    """With the same values it creeps as viscoelastic_creep does, and the two together as their sum."""
    run = Run("loaded", np.array([0.0, 1.0, 4.0]), None, "static_equilibrium", 0.0)
    values = {"modulus_ratio": 0.3, "relaxation_time": 6.0}
    tips = [
        simulate(cantilever().model(name, 0.05, 0.03, **values).with_numerics(steps_per_second=120), run)
        for name in ("slow_creep", "viscoelastic_creep")
    ]
    assert tips[0].sin_theta == pytest.approx(tips[1].sin_theta, abs=1e-9)
    both = cantilever().model("slow_creep", 0.05, 0.03, **values).with_effects("viscoelastic_creep")
    both = both.with_values(
        {"viscoelastic_creep.modulus_ratio": 0.3, "viscoelastic_creep.relaxation_time": 0.2}
    )
    found = simulate(both.with_numerics(steps_per_second=120), run)
    assert abs(found.sin_theta[1]) < abs(tips[0].sin_theta[1])
    assert found.sin_theta[2] == pytest.approx(tips[0].sin_theta[2], rel=0.05)
