# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Bodies that are YAML only: swimmer, arm, a beam with one muscle on one side, a finger with three."""

from pathlib import Path

import numpy as np
import pytest
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.errors import SimulationError
from hasel_sim.model import load_model, save_model
from hasel_sim.run import Run
from hasel_sim.simulate import simulate

BODIES = Path(__file__).parents[2] / "docs" / "bodies"
NAMES = ["swimmer", "arm", str(BODIES / "one_sided_beam.yaml"), str(BODIES / "finger.yaml")]
LEVELS = {"swimmer": 5000.0, "arm": 3.0e4, "one_sided_beam": 5000.0, "finger": 0.004}


def _held(model, active: list[str], duration: float = 1.0) -> Run:
    """Some channels held at a level from 0 s on."""
    on = np.array([[LEVELS[model.name] * (name in active) for name in model.channels]])
    return Run(
        "held", np.arange(round(duration * 60) + 1) / 60, DriveSchedule(np.zeros(1), on, model.channels)
    )


def _driven(name: str, contraction: float = 0.05):
    model = load_model(name)
    model = model.with_levels(np.array([LEVELS[model.name]]))
    (amplitude,) = [name for name in model.parameters if model.is_amplitude(name)]
    return model.with_values({amplitude: contraction})


@pytest.mark.parametrize("name", NAMES)
def test_every_muscle_bends_its_body_to_its_side(name):
    """Upper muscles to positive sin theta, lower ones to negative; nothing moves that is not driven."""
    model = _driven(name)
    for muscle in model.description.muscles:
        found = simulate(model, _held(model, [muscle.channel]))
        sign = 1.0 if muscle.layer == "upper" else -1.0
        assert sign * (found.sin_theta[-1] - found.sin_theta[0]) > 1e-4
        driven = np.ptp(found.contraction, axis=0) > 0
        assert [m.name for m, on in zip(model.description.muscles, driven, strict=True) if on] == [
            muscle.name
        ]


@pytest.mark.parametrize("name", NAMES)
def test_sensitivities_by_every_parameter_agree_with_differences(name):
    """The baseline's amplitudes and response, and the constants that the file frees."""
    model = _driven(name).with_numerics(tolerance_m=1e-12, steps_per_second=60.0)
    run, names = _held(model, list(model.channels[:1]), 0.5), list(model.parameters)
    slopes = simulate(model, run, names).slopes
    for column, parameter in enumerate(names):
        value = model.values[parameter]
        step = 1e-4 * model.parameters[parameter].magnitude
        above, below = (
            simulate(model.with_values({parameter: value + sign * step}), run).sin_theta for sign in (1, -1)
        )
        expected = (above - below) / (2 * step)
        assert slopes[:, column] == pytest.approx(expected, abs=1e-4 * np.abs(expected).max() + 1e-9), (
            parameter
        )


@pytest.mark.parametrize("name", NAMES)
def test_a_saved_body_is_the_same_body(name, tmp_path):
    """All sections come back."""
    model = _driven(name)
    save_model(model, tmp_path / "model.yaml")
    assert load_model(tmp_path / "model.yaml") == model


def test_markers_may_lie_anywhere_on_the_body():
    """Four of them, one off the centre line; where the beam is bent it stays at its distance."""
    model = _driven(NAMES[2])
    markers = simulate(model, _held(model, ["top"])).markers
    assert markers.shape[1:] == (4, 2)
    apart = np.linalg.norm(markers[:, 3] - markers[:, 1], axis=1)
    assert apart[0] == pytest.approx(0.004)
    assert apart == pytest.approx(0.004, rel=0.05)
    assert np.ptp(markers[:, 1, 1]) > 1e-3


def test_a_drive_that_fits_no_channel_is_refused():
    """Too many, and one too few; a channel too many that rests does no harm."""
    model = _driven(NAMES[2])
    both = DriveSchedule(np.zeros(1), np.array([[5000.0, 3000.0]]), ("top", "bottom"))
    with pytest.raises(SimulationError, match="'bottom', which contracts no muscle"):
        simulate(model, Run("both", np.arange(3) / 60, both))
    with pytest.raises(SimulationError, match="no drive for the channel 'top', only for side"):
        simulate(
            model, Run("other", np.arange(3) / 60, DriveSchedule(np.zeros(1), np.zeros((1, 1)), ("side",)))
        )
    resting = DriveSchedule(np.zeros(1), np.array([[5000.0, 0.0]]), ("top", "bottom"))
    alone = DriveSchedule(np.zeros(1), np.array([[5000.0]]), ("top",))
    found = [simulate(model, Run("", np.arange(30) / 60, drive)).sin_theta for drive in (resting, alone)]
    assert np.array_equal(*found)


def test_a_drive_that_is_no_number_is_refused():
    """An infinite or unknown voltage."""
    for value in (np.nan, np.inf):
        with pytest.raises(SimulationError, match=r"the drive at t = 0 s is .*expected finite numbers"):
            DriveSchedule(np.zeros(1), np.array([[value]]), ("top",))


def test_unequal_pretension_bends_the_body_at_rest(tmp_path):
    """It starts bent and stays so until it is driven; the derivative by the pretension is that of differences."""
    save_model(_driven("swimmer"), tmp_path / "model.yaml")
    text = (tmp_path / "model.yaml").read_text()
    entry = "parameters:\n  muscles.upper.rest_contraction: {value: 0.01, lower: 0.0, upper: 0.1}"
    (tmp_path / "model.yaml").write_text(text.replace("parameters:", entry))
    model = load_model(tmp_path / "model.yaml").with_numerics(tolerance_m=1e-12)
    name = "muscles.upper.rest_contraction"
    assert model.parameters[name].unit == "1"
    run = Run("rest", np.arange(31) / 60)
    found = simulate(model, run, [name])
    assert found.sin_theta[0] > 0.01
    assert np.ptp(found.sin_theta) < 1e-7
    above, below = (simulate(model.with_values({name: 0.01 + s * 1e-5}), run).sin_theta for s in (1, -1))
    assert found.slopes[:, 0] == pytest.approx((above - below) / 2e-5, rel=1e-5)
    equal = model.with_values({name: 0.0})
    assert simulate(equal, run).sin_theta == pytest.approx(0.0, abs=1e-9)


def test_a_stiff_region_bends_less_than_the_rest():
    """With a head of a hundred times the stiffness, the part before the muscles stays straight under gravity."""
    model = load_model(NAMES[3])
    body = model.description.body
    hard = body.regions[0].model_copy(update={"from_m": 0.0, "to_m": 0.045, "layer": "whole"})
    bent = []
    for regions in ((), (hard,)):
        changed = model.description.model_copy(
            update={
                "body": body.model_copy(update={"regions": regions}),
                "material": model.description.material.model_copy(update={"gravity_m_per_s2": (0.0, -9.81)}),
            }
        )
        markers = simulate(type(model)(changed, (), model.parameters), Run("rest", np.zeros(1))).markers[0]
        bent.append(-markers[:, 1])
    assert bent[1][1] < 0.3 * bent[0][1]
    assert bent[1][2] < bent[0][2]
