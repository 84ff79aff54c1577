# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The whole drive from voltage to contraction.

The instants at which a drive begins or ceases to contract.
Muscles that follow the law of the Peano-HASEL in place of a table of amplitudes.
"""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sim.drive.chain import DriveChain, PeanoHaselDrive, crossings, with_onsets
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.effects.base import DriveEffect, DriveStage, EffectParameter
from hasel_sim.effects.drive.charging_lag import ChargingLag
from hasel_sim.errors import ModelError
from hasel_sim.model import load_model, save_model
from hasel_sim.model.muscle_file import load_muscle, muscle_text
from hasel_sim.run import Run
from hasel_sim.simulate import simulate
from numpy.testing import assert_allclose
from scipy.optimize import brentq

VALUES = {"amplitude_5500": 0.06, "slope": 0.3}


class Gain(DriveEffect):
    """Multiplies the voltage."""

    id = "gain"
    stage = DriveStage.SUPPLY
    parameters = (EffectParameter("factor", "g", "1", 1.0, 0.0, 2.0, 0.5),)

    def respond(self, time, signal, p: SimpleNamespace):
        """Scaled."""
        return p.factor * signal


class Delay(DriveEffect):
    """Shifts the contraction in time."""

    id = "delay"
    stage = DriveStage.CONTRACTION
    parameters = (EffectParameter("time", "t", "s", 0.0, 0.0, 1.0, 0.1),)

    def clock(self, time, p: SimpleNamespace):
        """Later."""
        return time + p.time


def _chain(effects, levels) -> DriveChain:
    """Of the swimmer with these effects and levels [V]."""
    return DriveChain(replace(load_model("swimmer").with_levels(np.array(levels)), effects=tuple(effects)))


def _contraction(effects, values, times):
    schedule = DriveSchedule(np.array([0.0, 0.5]), np.array([[5500.0, 0.0], [0.0, 5500.0]]))
    return _chain(effects, [5500.0]).contraction(schedule, times, VALUES, values)


def test_a_switch_between_two_instants_acts_from_its_own_time():
    """The grid of the answer does not move the ramp: exact at any instants asked for."""
    coarse = _contraction([], {}, np.array([0.0, 0.45, 0.55, 0.62]))
    assert coarse == pytest.approx(
        np.array([[0.0, 0.0], [0.06, 0.0], [0.045, 0.015], [0.024, 0.036]]), abs=1e-12
    )


def test_effects_act_in_the_order_of_their_stage():
    """A gain on the voltage changes the target, a delay the contraction, however they are listed."""
    times = np.linspace(0, 1, 21)
    values = {"gain": SimpleNamespace(factor=0.0), "delay": SimpleNamespace(time=0.1)}
    assert not _contraction([Delay(), Gain()], values, times).any()
    values["gain"].factor = 1.0
    found, plain = _contraction([Delay(), Gain()], values, times), _contraction([], {}, times)
    assert found[2:] == pytest.approx(plain[:-2])


def test_a_lag_is_as_exact_on_a_coarse_grid_as_on_a_fine_one():
    """What a longer discharge changes is smooth in the discharge time: no instant of the grid shows through."""
    drive = np.array([[5500.0, 0.0], [0.0, 5500.0], [5500.0, 0.0], [0.0, 5500.0]])
    schedule = DriveSchedule(np.arange(4) / 7, drive)
    chain = _chain([ChargingLag()], [3500.0, 4500.0, 5500.0])
    amplitudes = {
        "amplitude_3500": 0.0269,
        "amplitude_4500": 0.0437,
        "amplitude_5500": 0.0633,
        "onset": 1500.0,
    }

    def change(rate: int, discharge_time: float) -> np.ndarray:
        times = np.arange(0, 4 / 7, 1 / rate)
        longer, shorter = (
            chain.contraction(
                schedule,
                times,
                {**amplitudes, "slope": 0.26},
                {"charging_lag": SimpleNamespace(charge_time=0.053, discharge_time=time)},
            )
            for time in (discharge_time + 0.001, discharge_time - 0.001)
        )
        return (longer - shorter)[:: rate // 240]

    for discharge_time in np.linspace(0.04, 0.06, 11):
        fine = change(24000, discharge_time)
        assert np.linalg.norm(change(240, discharge_time) - fine) < 0.15 * np.linalg.norm(fine)


def test_a_lag_delays_the_ramp_by_what_its_onset_takes():
    """The ramp begins where the lagging voltage passes the onset, however fine the grid: tau log(V / (V - onset))."""
    levels = [3500.0, 4500.0, 5500.0]
    amplitudes = [0.0316, 0.0502, 0.0699]
    threshold = 1600.0
    values = {f"amplitude_{v:g}": a for v, a in zip(levels, amplitudes, strict=True)}
    values |= {"slope": 0.26, "onset": threshold}
    chain = _chain([ChargingLag()], levels)
    schedule = DriveSchedule(np.array([0.0]), np.array([[3500.0, 0.0]]))
    for charge_time in (1e-4, 1e-3, 5e-3, 0.02, 0.021, 0.022):
        lag = SimpleNamespace(charge_time=charge_time, discharge_time=0.0)
        times = np.arange(0.0, 0.2, 1 / 240)
        reached = chain.contraction(schedule, times, values, {"charging_lag": lag})[:, 0]
        begin = float(np.interp(0.02, reached, times)) - 0.02 / 0.26
        least = charge_time * np.log(3500 / (3500 - threshold))
        assert least - 1.5e-4 < begin < 1.3 * least + 1.5e-4


def _with(time, signal, onsets):
    return with_onsets(time, signal, onsets, crossings(time, signal, onsets))


def test_a_crossing_gets_an_instant_and_a_jump_does_not():
    """Up, down on the negative side, and past the onset at once."""
    time = np.array([0.0, 1.0, 2.0, 2.0, 3.0])
    signal = np.array([[0.0], [4.0], [4.0], [-4.0], [0.0]])
    found, rows = _with(time, signal, np.array([1.0]))
    assert_allclose(found, [0.0, 0.25, 1.0, 2.0, 2.0, 2.75, 3.0])
    assert_allclose(rows[:, 0], [0.0, 1.0, 4.0, 4.0, -4.0, -1.0, 0.0])


def test_channels_that_cross_between_the_same_times_are_put_in_order():
    """The second is at its onset first; each one's row holds where the other is meanwhile."""
    found, rows = _with(np.array([0.0, 1.0]), np.array([[0.0, 0.0], [10.0, 10.0]]), np.array([8.0, 2.0]))
    assert_allclose(found, [0.0, 0.2, 0.8, 1.0])
    assert_allclose(rows, [[0.0, 0.0], [2.0, 2.0], [8.0, 8.0], [10.0, 10.0]])


def test_without_an_onset_nothing_is_added():
    """A drive that contracts from 0 V on has no corner."""
    time, signal = np.linspace(0, 1, 5), np.linspace(0, 1, 5)[:, None]
    found, rows = _with(time, signal, np.zeros(1))
    assert_allclose(found, time)
    assert_allclose(rows, signal)


LAW = "muscle: {law: peano_hasel, file: peano_hasel}\n"
SWIMMER = """
name: lawful
body: {length_m: 0.1, height_m: 0.01}
material:
  soft: {youngs_modulus_pa: 65.0e+3, poissons_ratio: 0.45, density_kg_per_m3: 900.0, retardation_time_s: 0.02}
channels: [{name: upper}, {name: lower}]
muscles:
  - {name: upper, channel: upper, layer: upper, from_m: 0.02, to_m: 0.09, fibre_stiffness_pa: 65.0e+3}
  - {name: lower, channel: lower, layer: lower, from_m: 0.02, to_m: 0.09, fibre_stiffness_pa: 65.0e+3}
markers: {head: {x_m: 0.0}, middle: {x_m: 0.05}, tail: {x_m: 0.1}}
"""


@pytest.fixture
def read(tmp_path):
    """Reads a model from its text."""

    def read(text):
        (tmp_path / "model.yaml").write_text(text)
        return load_model(tmp_path / "model.yaml")

    return read


def test_contraction_is_the_balance_with_the_body(read):
    """F(V, e) = preload + stiffness e, found here by a scalar root finder; the fibres get gain times e."""
    model = read(SWIMMER + LAW).with_values(
        {"muscle.preload": 0.3, "muscle.stiffness": 12.0, "muscle.gain": 0.7}
    )
    found = PeanoHaselDrive(model.description.muscle).contraction(
        np.array([[0.0, -4000.0], [4000.0, 6000.0]]), model.values
    )
    pouch = load_muscle("peano_hasel").pouch

    def expected(volts):
        def surplus(angle):
            strain = float(pouch.contraction(np.array(angle))) / pouch.relaxed_length
            return float(pouch.force(volts, angle)) - 0.3 - 12.0 * strain

        angle = brentq(surplus, pouch.relaxed_angle, np.pi / 2, xtol=1e-14)
        return 0.7 * float(pouch.contraction(np.array(angle))) / pouch.relaxed_length

    assert_allclose(
        found, [[0.0, expected(4000.0)], [expected(4000.0), expected(6000.0)]], rtol=1e-8, atol=1e-12
    )


def test_onset_is_where_the_preload_is_lifted(read):
    """Just below it nothing contracts, just above something; none without a preload."""
    model = read(SWIMMER + LAW).with_values({"muscle.preload": 0.3, "muscle.gain": 1.0})
    drive = PeanoHaselDrive(model.description.muscle)
    onset = drive.onset(model.values)
    assert onset > 500.0
    below, above = drive.contraction(np.array([0.999 * onset, 1.001 * onset]), model.values)
    assert abs(below) < 1e-12 < 1e-7 < above
    assert drive.onset({**model.values, "muscle.preload": 0.0}) == 0.0


def test_law_stands_in_for_the_table(read):
    """There are no amplitudes to free, at whatever voltage; a held voltage ends at what the law says."""
    model = read(SWIMMER + LAW).with_levels([3000.0, 5000.0])
    assert not any(model.is_amplitude(name) for name in model.parameters)
    assert model.levels.tolist() == [3000.0, 5000.0]
    schedule = DriveSchedule(np.array([0.0]), np.array([[4000.0, 0.0]]))
    times = np.linspace(0.0, 5.0, 50)
    reached = DriveChain(model).contraction(schedule, times, model.values, {})[-1]
    aimed = PeanoHaselDrive(model.description.muscle).contraction(np.array([4000.0, 0.0]), model.values)
    assert_allclose(reached, aimed, rtol=1e-9, atol=1e-12)


def test_simulation_is_differentiated_by_the_law(read):
    """Derivatives of the angle by preload and gain are those of finite differences."""
    model = read(SWIMMER + LAW).with_values({"muscle.gain": 1.0, "slope": 5.0})
    time = np.arange(0.0, 0.3, 1 / 120)
    run = Run("law", time, DriveSchedule(np.array([0.0]), np.array([[5000.0, 0.0]])))
    names = ("muscle.preload", "muscle.gain")
    found = simulate(model, run, names).slopes
    for column, name in enumerate(names):
        step = 1e-4 * model.values[name]
        ends = [
            simulate(model.with_values({name: model.values[name] + s}), run).sin_theta for s in (step, -step)
        ]
        assert_allclose(found[:, column], (ends[0] - ends[1]) / (2 * step), rtol=1e-3, atol=1e-6)


def test_a_fitted_muscle_takes_its_place(read, tmp_path):
    """A muscle file of the bench may be named; its constants and effects are taken over, but for those in time."""
    muscle = load_muscle("peano_hasel").with_effects("edge_effect", "film_creep")
    muscle = muscle.with_values({"pouch.fill": 0.8, "edge_effect.strip": 0.4, "film_creep.share": 0.1})
    (tmp_path / "mine.yaml").write_text(muscle_text(muscle))
    law = read(SWIMMER + "muscle: {law: peano_hasel, file: mine.yaml}\n").description.muscle
    assert law.pouch.fill == 0.8
    assert law.effects == {"edge_effect": {"strip": 0.4}}
    ((_, pouch),) = law.muscle().populations
    assert_allclose(pouch.width, 0.050 - 2 * 0.4 * 0.020)


def test_a_lawful_model_survives_its_file(read, tmp_path):
    """What is written needs no muscle file beside it and reads back to the same model."""
    model = read(SWIMMER + LAW).with_values({"muscle.preload": 2.0})
    save_model(model, tmp_path / "copy.yaml")
    assert load_model(tmp_path / "copy.yaml") == model


@pytest.mark.parametrize(
    ("section", "message"),
    [
        ("muscle: {law: peano}\n", "muscle.law is 'peano'"),
        ("muscle: {law: peano_hasel}\n", "expected either pouch or file"),
        ("muscle: {law: peano_hasel, file: peano}\n", "nearest known one is 'peano_hasel'"),
        (
            "muscle: {law: peano_hasel, pouch: {count: 1, film_length_m: 0.02}}\n",
            "electrode_length_m' is missing",
        ),
        (
            "muscle: {law: peano_hasel, pouch: {count: 1, film_length_m: 0.02, electrode_length_m: 0.03, width_m: 0.1, "
            "film_thickness_m: 1.0e-5, relative_permittivity: 2.0}}\n",
            "less than the film's length",
        ),
        (LAW.replace("}", ", effects: {edge: {strip: 1.0}}}"), "move them there"),
        (LAW + "parameters: {muscle.prelaod: {value: 1.0}}\n", "nearest known one is 'muscle.preload'"),
    ],
)
def test_faults_get_one_sentence(read, section, message):
    """What is wrong with the section is said with what was expected."""
    with pytest.raises(ModelError, match=message):
        read(SWIMMER + section)


def test_a_law_of_voltages_needs_a_voltage(read):
    """A body driven by pressure cannot follow it."""
    text = SWIMMER.replace("{name: upper}", "{name: upper, quantity: pressure, unit: Pa}")
    with pytest.raises(ModelError, match="no channel is a voltage"):
        read(text.replace("{name: lower}", "{name: lower, quantity: pressure, unit: Pa}") + LAW)
