"""A force of the fluid that is hidden from the model of a free swimmer: the search from recordings to a name."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_recording import Recording
from hasel_sim.model import load_model
from hasel_sim.simulate import simulate_many
from hasel_sim.swimming.boxes import Boxes
from hasel_sysid.dataset import experiment
from hasel_sysid.improve import improve
from hasel_sysid.problem import Problem

SECONDS, NOISE = 2.8, 0.003
BOXES = [Boxes(volts, volts, hertz) for volts, hertz in ((4500, 1.5), (5500, 2.5), (5500, 1.5), (4500, 2.5))]
CANDIDATES = (
    *("normal_drag", "form_drag", "viscous_drag", "reactive_force", "finite_depth_added_mass", "added_mass"),
    *("linear_drag", "soft_modulus", "transport_delay"),
)
pytestmark = [pytest.mark.slow, pytest.mark.timeout(1800)]


@pytest.mark.parametrize("hidden", ["normal_drag", "reactive_force"])
def test_a_hidden_force_of_the_fluid_is_named(pool, hidden):
    """Three swims in oil are fitted, one is not; the truth has a finer mesh, and a force that the model lacks."""
    truth = load_model("swimmer_in_oil")
    lacking = truth.without_effects(hidden).with_numerics(mesh_density=0.7)
    present = {effect.id for effect in lacking.effects}
    candidates = [name for name in CANDIDATES if name not in present]
    free = {
        name: replace(p, free=name.startswith(("amplitude", "slope")))
        for name, p in lacking.parameters.items()
    }
    runs = [box.run(truth, SECONDS) for box in BOXES]
    rng = np.random.default_rng(5)
    swims = [
        experiment(
            Recording(
                str(box),
                swum.time,
                swum.sin_theta + NOISE * rng.standard_normal(len(swum.time)),
                drive_time_s=run.schedule.time,
                drive_values=run.schedule.signal,
            )
        )
        for box, run, swum in zip(BOXES, runs, simulate_many([(truth, run) for run in runs]), strict=True)
    ]
    model = replace(lacking, parameters=free)
    found = improve(Problem(swims[:3], pool), model, Problem(swims[3:], pool), only=candidates)
    assert found.status == "explained" and found.missing == (hidden,)
    first, last = found.stages[0], found.stages[-1]
    assert last.mae_validation < 0.3 * first.mae_validation
