# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Faults of the set-up beside a model: told apart from physics, and from what is in order."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_recording import Recording
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.model import load_model
from hasel_sim.parallel import SerialExecutor
from hasel_sim.run import Run
from hasel_sim.simulate import simulate
from hasel_sysid.answer.result import Status
from hasel_sysid.dataset import prepared
from hasel_sysid.experiment import Experiment
from hasel_sysid.improvement import improve
from hasel_sysid.problem import Problem

COARSE = {"mesh_density": 0.5, "quadrature_order": 2, "steps_per_second": 120.0}
TRUTH = {"mesh_density": 0.8, "quadrature_order": 2, "steps_per_second": 480.0, "spectral_radius": 1.0}
VALUES = {"amplitude_3500": 0.027, "amplitude_5500": 0.062, "slope": 0.3}
CONDITIONS = ((3500.0, 1.0), (3500.0, 2.0), (5500.0, 1.0), (5500.0, 2.0))
NOTHING = (lambda schedule: schedule, 1.0)


def _dead(channel):
    alive = np.arange(2) != channel
    return lambda schedule: replace(schedule, signal=schedule.signal * alive)


def _moved(seconds):
    return lambda schedule: replace(schedule, time=schedule.time + seconds)


def _exchanged(schedule):
    return replace(schedule, signal=schedule.signal[:, ::-1])


FAULTS = {
    "upper channel is dead in run 2": ((_dead(0), 1.0), (2,)),
    "lower channel is dead in all runs": ((_dead(1), 1.0), range(4)),
    "exchanged in run 1": ((_exchanged, 1.0), (1,)),
    "wrong sign in all runs": ((lambda schedule: schedule, -1.0), range(4)),
    "clock of the angle is off by +150 ms in run 3": ((_moved(0.15), 1.0), (3,)),
}


QUICK = ("lower channel is dead in all runs", "clock of the angle is off by +150 ms in run 3")


def measured(effect=None, fault=NOTHING, faulty=(), **values):
    """Four runs of a truth on another mesh and other steps, in white noise, of which some have a fault."""
    truth = load_model("swimmer").with_numerics(**TRUTH).with_levels(np.array([3500.0, 5500.0]))
    truth = (truth.with_effects(effect) if effect else truth).with_values({**VALUES, **values})
    experiments = []
    for number, (voltage, frequency) in enumerate(CONDITIONS):
        frames = np.arange(0, 2 / frequency, 1 / 120)
        side = np.mod(frames * frequency, 1) < 0.5
        run = Run(f"run {number}", frames, DriveSchedule(frames, voltage * np.column_stack([side, ~side])))
        drive, sign = fault if number in faulty else NOTHING
        angle = sign * simulate(truth, replace(run, schedule=drive(run.schedule))).sin_theta
        noise = 0.002 * np.random.default_rng(number).normal(size=len(frames))
        recording = Recording(run.name, frames, angle + noise, drive_signal=run.schedule.signal)
        experiments.append(Experiment(recording, run))
    return experiments


def improved(experiments):
    """With two candidates, the coarse swimmer being the model."""
    model = prepared(load_model("swimmer").with_numerics(**COARSE), experiments)
    return improve(Problem(experiments, SerialExecutor()), model, only=("quadratic_drag", "camera_latency"))


@pytest.mark.parametrize(
    "said", [*QUICK, *(pytest.param(name, marks=pytest.mark.slow) for name in FAULTS if name not in QUICK)]
)
def test_a_fault_is_named_as_one(said):
    """With its runs, and no physics beside it."""
    fault, faulty = FAULTS[said]
    found = improved(measured(None, fault, faulty))
    if (
        "exchanged" in said or "wrong sign" in said
    ):  # of a body that is the same on both sides, one is the other
        assert found.set_up.runs == tuple(f"run {n}" for n in faulty)
        assert found.set_up.everywhere == (len(faulty) == 4)
    else:
        assert said in str(found.set_up)
    assert found.status is Status.NOTHING_MISSING
    assert str(found.set_up) in found.to_json()["verdict"]["reason"]
    assert found.to_json()["verdict"]["set_up"] == str(found.set_up)


def test_what_is_missing_is_named_beside_the_fault():
    """A drag, where one run was driven by one muscle only."""
    fault, _ = FAULTS["upper channel is dead in run 2"]
    found = improved(measured("quadratic_drag", fault, (2,), **{"quadratic_drag.coefficient": 0.25}))
    assert found.missing == ("quadratic_drag",)
    assert "upper channel is dead in run 2" in str(found.set_up)
    assert found.model.values["quadratic_drag.coefficient"] == pytest.approx(0.25, rel=0.1)


@pytest.mark.parametrize(
    ("effect", "values"),
    [
        pytest.param("quadratic_drag", {"coefficient": 2.5}, marks=pytest.mark.slow),
        ("camera_latency", {"latency": 0.04}),
        ("camera_latency", {"latency": -0.05}),
    ],
)
def test_strong_physics_is_no_fault(effect, values):
    """A drag ten times the typical one; clocks of camera and drive that differ in every run alike, either way, are an
    effect of the catalogue.
    """
    found = improved(measured(effect, **{f"{effect}.{name}": value for name, value in values.items()}))
    assert found.set_up is None
    assert found.missing == (effect,)
