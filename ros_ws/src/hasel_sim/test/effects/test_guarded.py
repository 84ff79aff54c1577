# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""An effect of the user's own that fails where a search tries it: a sentence, and no stack trace."""

import numpy as np
import pytest
from hasel_sim.errors import ModelError
from hasel_sim.model import load_model
from hasel_sim.run import Run
from hasel_sim.simulate import simulate

OWN = """
import numpy as np
from hasel_sim.effects.base import DriveEffect, EffectParameter, ForceEffect, ObservationEffect

SIZE = (EffectParameter("size", "s", "1", 0.0, 0.0, 1.0, 0.1),)


def checked(p):
    if p.size <= 0.2:
        return p.size
    raise ValueError("there is no law beyond 0.2")


class Driven(DriveEffect):
    id, physics, equation, parameters, signature = "driven", "Less.", "(1 - s) u", SIZE, "Less."

    def respond(self, time, signal, p):
        return (1 - checked(p)) * signal


class Pushed(ForceEffect):
    id, physics, equation, parameters, signature = "pushed", "Drag.", "-s v", SIZE, "Slower."

    def force(self, at, p):
        return -checked(p) * at.velocity


class Seen(ObservationEffect):
    id, physics, equation, parameters, signature = "seen", "Less.", "(1 - s) theta", SIZE, "Less."

    def angle(self, time, sin_theta, p):
        return (1 - checked(p)) * sin_theta
"""


@pytest.mark.parametrize(("name", "method"), [("Driven", "respond"), ("Pushed", "force"), ("Seen", "angle")])
def test_it_is_named_with_its_method_and_reason(name, method, tmp_path):
    """It passes every check at its typical value; beyond that its failure is the model's, not the program's."""
    path = tmp_path / "own.py"
    path.write_text(OWN)
    model = load_model("swimmer").with_numerics(mesh_density=0.5).with_levels([5500.0])
    model = model.with_effects(f"{path}:{name}")
    run = Run("let go", np.arange(0.0, 0.1, 0.01), None)
    simulate(model.with_values({f"{name.lower()}.size": 0.1}), run)
    expected = rf"{name}' fails in {method} \(ValueError: there is no law beyond 0.2\): correct that method"
    with pytest.raises(ModelError, match=expected):
        simulate(model.with_values({f"{name.lower()}.size": 0.5}), run)
