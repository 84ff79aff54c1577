# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""From recordings of a swimmer to the interval of its fastest frequency: fit, model file, sweep."""

import json
from dataclasses import replace

import numpy as np
import pytest
from hasel_recording import Recording, write_recording
from hasel_sim.commands import entry
from hasel_sim.model import Model, load_model, save_model
from hasel_sim.simulate import simulate_many
from hasel_sim.swimming.boxes import Boxes
from hasel_sim.swimming.sweep import WITHIN, Optimum, optimum, standard_error_of, swim_together, uncertain
from hasel_sysid.command_line import fit

FREE = ("slope", "amplitude_5500", "reactive_force.coefficient")
NOISE, SECONDS, FREQUENCIES = 0.003, 2.8, (1.5, 2.0, 2.5, 3.0)


@pytest.fixture(scope="module")
def fish() -> Model:
    """The swimmer in oil on a coarse mesh, of which three parameters are not known."""
    model = load_model("swimmer_in_oil").with_numerics(mesh_density=0.5, steps_per_second=120.0)
    return replace(
        model, parameters={name: replace(p, free=name in FREE) for name, p in model.parameters.items()}
    )


@pytest.fixture(scope="module")
def chain(tmp_path_factory, fish):
    """The model file that `fit` wrote of three noisy swims, and what `swim` made of it as JSON."""
    folder = tmp_path_factory.mktemp("chain")
    save_model(fish.with_values({"slope": 0.3, "amplitude_5500": 0.055}), folder / "start.yaml")
    runs = [Boxes(5500, 5500, hertz).run(fish, SECONDS) for hertz in (1.5, 2.0, 3.0)]
    rng, recordings = np.random.default_rng(3), []
    for run, swum in zip(runs, simulate_many([(fish, run) for run in runs]), strict=True):
        recordings.append(str(folder / f"run_{len(recordings)}.csv"))
        seen = swum.sin_theta + NOISE * rng.standard_normal(len(swum.time))
        drive = {"drive_time_s": run.schedule.time, "drive_values": run.schedule.signal}
        write_recording(Recording(run.name, swum.time, seen, **drive), recordings[-1])
    given = [*recordings, "--model", str(folder / "start.yaml"), "--jobs", "1"]
    assert fit.main([*given, "--output", str(folder / "fit")]) == 0
    fitted = folder / "fit" / fit.MODEL_FILE
    wanted = ["--voltage", "5500", "--frequency", ",".join(f"{f:g}" for f in FREQUENCIES)]
    written = ["--output", str(folder / "swim"), "--json", str(folder / "swim.json"), "--jobs", "1"]
    assert entry.swim(["--model", str(fitted), *wanted, "--duration", f"{SECONDS:g}", *written]) == 0
    return load_model(str(fitted)), json.loads((folder / "swim.json").read_text())["optima"]["5500 V"]


def speeds(cases: list[tuple[Model, float]]) -> list[float]:
    """What models swim at under boxes of so many Hz [m/s]."""
    return [swim_together(model, [Boxes(5500, 5500, f)], SECONDS)[0].speed_m_per_s for model, f in cases]


def test_the_fastest_frequency_is_known_as_well_as_the_recordings_tell(fish, chain):
    """The interval follows from errors and correlations of the file, and holds the true optimum."""
    fitted, found = chain
    assert set(uncertain(fitted)) == set(FREE)
    true = optimum(FREQUENCIES, speeds([(fish, f) for f in FREQUENCIES]))
    low, high = found["interval_hz"]
    assert low < true.frequency < high
    top = Optimum(found["frequency"], found["speed"])
    assert (high - low) / (2 * WITHIN) == pytest.approx(standard_error_of(fitted, top, 0.5, speeds))


def test_without_the_correlations_it_would_be_another(chain):
    """Muscle and fluid make up for each other in what was recorded: taken for independent, their errors say less."""
    fitted, found = chain
    top = Optimum(found["frequency"], found["speed"])
    independent = fitted.with_values(fitted.values, uncertain(fitted))
    assert independent.covariance(FREE)[0, 1] == 0.0
    assert standard_error_of(independent, top, 0.5, speeds) > 2 * found["standard_error"]
