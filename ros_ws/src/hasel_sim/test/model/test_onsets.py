# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The onset of muscles as a parameter."""

import numpy as np
import pytest
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.errors import ModelError
from hasel_sim.model import load_model, save_model
from hasel_sim.prepared_run import PreparedRun
from hasel_sim.run import Run

LEVELS = (3500.0, 4500.0, 5500.0)


def swimmer(*effects: str):
    """The swimmer with three voltages and some effects."""
    return load_model("swimmer").with_levels(LEVELS).with_effects(*effects)


def test_there_is_an_onset_where_the_drive_passes_levels_that_nobody_commanded():
    """A lag sweeps through all of them; a dead time, a weaker muscle or a drag passes none."""
    assert swimmer("charging_lag").parameters["onset"].unit == "V"
    assert swimmer("charging_lag").free[-1] == "onset"
    for model in (swimmer(), swimmer("transport_delay", "muscle_asymmetry", "quadratic_drag")):
        assert "onset" not in model.parameters


def test_it_goes_with_the_last_effect_that_needs_it():
    """And stays, with its value, beside another one."""
    model = swimmer("charging_lag", "drive_creep").with_values({"onset": 900.0})
    assert model.without_effects("charging_lag").values["onset"] == 900.0
    assert "onset" not in model.without_effects("charging_lag", "drive_creep").parameters


def test_it_lies_below_the_lowest_level():
    """At most 0.8 of it, also after the levels have changed."""
    model = swimmer("charging_lag").with_values({"onset": 2800.0})
    assert model.parameters["onset"].upper == pytest.approx(2800.0)
    assert model.with_levels([1000.0, 3500.0]).values["onset"] == pytest.approx(800.0)


def test_every_quantity_has_its_own():
    """The arm's pressure passes all levels by its own lag."""
    arm = load_model("arm").with_levels([10e3, 20e3])
    assert arm.parameters["onset_pa"].unit == "Pa"


def test_a_file_keeps_it_and_may_hold_it_fixed(tmp_path):
    """Written and read back; one that was measured is not fitted; one in another unit is refused."""
    path = tmp_path / "model.yaml"
    model = swimmer("charging_lag").with_values({"onset": 1500.0}, {"onset": 30.0})
    save_model(model, path)
    assert load_model(path) == model
    text = path.read_text()
    entry = text[text.index("  onset:") :]
    path.write_text(text.replace(entry, entry.replace("free: true", "free: false")))
    assert "onset" not in load_model(path).free
    path.write_text(text.replace(entry, entry.replace("unit: V", "unit: kV")))
    with pytest.raises(ModelError, match="onset is given in 'kV'; expected 'V'"):
        load_model(path)


def test_a_file_from_before_gets_one(tmp_path):
    """A lag of a file that says nothing of an onset has none, which is what 0 V means."""
    path = tmp_path / "model.yaml"
    save_model(swimmer("charging_lag"), path)
    text = path.read_text()
    path.write_text(text[: text.index("  onset:")])
    assert load_model(path).values["onset"] == 0.0


@pytest.mark.parametrize("onset", [0.0, 1e-4, 1e-2, 1.0])
def test_its_derivative_is_not_round_off_near_none(onset):
    """A search that starts at none passes through onsets of no size; there too the slope is that of half a volt."""
    time = np.arange(0.0, 1.0, 1 / 120)
    signal = np.where((time % 0.5 < 0.25)[:, None], [4500.0, 0.0], [0.0, 4500.0])
    run = Run("square", time, DriveSchedule(time, signal, ("upper", "lower")))
    model = swimmer("charging_lag").with_values(
        {"charging_lag.charge_time": 0.05, "charging_lag.discharge_time": 0.05, "onset": onset}
    )
    ready = PreparedRun(model, run, ("onset",))
    times = ready.plan.balance_times
    slope = ready.contraction_slopes(times)[:, 0]
    above, below = (ready.contraction(times, {**model.values, "onset": v}) for v in (onset + 0.5, onset))
    assert np.abs(slope - (above - below) / 0.5).max() < 1e-3 * np.abs(slope).max()
