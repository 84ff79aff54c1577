# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A force of the fluid that is hidden from the model of a swimmer: the search from recordings to a name."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_recording import Recording
from hasel_sim.effects.registry import catalogue
from hasel_sim.model import Model, load_model
from hasel_sim.simulate import simulate_many
from hasel_sim.swimming.boxes import Boxes
from hasel_sysid.experiment import experiment_of
from hasel_sysid.improvement import improve
from hasel_sysid.problem import Problem

SECONDS, NOISE = 2.8, 0.003
FREQUENCIES = (1.5, 2.5, 1.5, 2.5)
CANDIDATES = (
    *(
        "normal_drag",
        "skin_friction",
        "form_drag",
        "viscous_drag",
        "reactive_force",
        "finite_depth_added_mass",
    ),
    *("added_mass", "linear_drag", "soft_modulus", "transport_delay"),
)
pytestmark = [pytest.mark.slow, pytest.mark.timeout(1800)]


def with_force(model: Model, identity: str) -> Model:
    """A model with a force of the fluid at the size it has there already, or else its typical one."""
    if identity in {effect.id for effect in model.effects}:
        return model
    force = catalogue()[identity]
    rivals = [e.id for e in model.effects if force.exclusive and e.exclusive == force.exclusive]
    without = model.without_effects(*rivals) if rivals else model
    return without.with_effects(identity).with_values(
        {f"{identity}.{p.name}": p.typical for p in force.parameters}
    )


def held(model: Model) -> Model:
    """The same body, held by its head."""
    body = model.description.body.model_copy(update={"clamped": True})
    return replace(model, description=model.description.model_copy(update={"body": body}))


def found_in(truth: Model, hidden: str, volts: tuple[float, ...], density: float, pool):
    """What `improve` says of three noisy recordings of a truth, and one unseen, without the hidden force."""
    truth = truth.with_levels(sorted(set(volts)))
    lacking = truth.without_effects(hidden).with_numerics(mesh_density=density)
    present = {effect.id for effect in lacking.effects}
    free = {
        name: replace(p, free=name.startswith(("amplitude", "slope")))
        for name, p in lacking.parameters.items()
    }
    boxes = [Boxes(v, v, f) for v, f in zip(volts, FREQUENCIES, strict=True)]
    runs = [box.run(truth, SECONDS) for box in boxes]
    rng = np.random.default_rng(5)
    seen = [
        experiment_of(
            Recording(
                str(box),
                swum.time,
                swum.sin_theta + NOISE * rng.standard_normal(len(swum.time)),
                drive_time_s=run.schedule.time,
                drive_values=run.schedule.signal,
            )
        )
        for box, run, swum in zip(boxes, runs, simulate_many([(truth, run) for run in runs]), strict=True)
    ]
    return improve(
        Problem(seen[:3], pool),
        replace(lacking, parameters=free),
        Problem(seen[3:], pool),
        only=[name for name in CANDIDATES if name not in present],
    )


def is_named(found, hidden: str) -> bool:
    """Whether the search ends with this force alone, and with noise."""
    first, last = found.stages[0], found.stages[-1]
    return (
        found.status == "explained"
        and found.missing == (hidden,)
        and last.mae_validation - NOISE * np.sqrt(2 / np.pi) < 0.1 * first.mae_validation
    )


@pytest.mark.parametrize(
    "hidden", ["normal_drag", "skin_friction", "form_drag", "viscous_drag", "reactive_force"]
)
def test_what_is_hidden_from_a_free_swimmer_is_named(hidden, pool):
    """Among seven or eight candidates; the truth has a finer mesh."""
    truth = with_force(load_model("swimmer_in_oil"), hidden)
    assert is_named(found_in(truth, hidden, (4500, 5500, 5500, 4500), 0.7, pool), hidden)


def test_the_inertia_alone_is_named_where_the_body_is_held(pool):
    """It is told from the reactive force, which sheds what it carries; at voltages whose motion the meshes share."""
    hidden = "finite_depth_added_mass"
    truth = held(with_force(load_model("swimmer_in_oil"), hidden)).with_numerics(mesh_density=1.5)
    assert is_named(found_in(truth, hidden, (2500, 3500, 3500, 2500), 1.0, pool), hidden)
