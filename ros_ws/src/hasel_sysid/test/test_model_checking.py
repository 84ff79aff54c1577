# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Whether a model describes its runs, and where it does not."""

import numpy as np
import pytest
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.model import load_model
from hasel_sim.run import Run
from hasel_sysid.estimation import FittedModel
from hasel_sysid.model_checking import goodness_of_fit, trends
from hasel_sysid.noise import NoiseModel
from hasel_sysid.testing.made_up_runs import evaluation_of_runs

TIME = np.arange(0, 2.0, 1 / 120)
SWIMMER = load_model("swimmer")
NOISE = NoiseModel(white=4e-6, coloured=5e-6, correlation=0.9)


def _run(voltage, frequency):
    time = np.arange(0, 2.0, 0.5 / frequency)
    upper = np.arange(len(time)) % 2 == 0
    schedule = DriveSchedule(time, voltage * np.stack([upper, ~upper], axis=1))
    return Run(f"{voltage:g}V_{frequency:g}Hz", TIME, schedule)


def _evaluation(seed, missed=lambda run: 0.0):
    runs = [_run(v, f) for v in (3500.0, 4500.0, 5500.0) for f in (1.0, 2.0, 4.0)]
    numbers = np.repeat(np.arange(len(runs)), len(TIME))
    residual = NOISE.sample(numbers, 1, np.random.default_rng(seed))[:, 0]
    residual = residual + np.concatenate([np.broadcast_to(missed(run), len(TIME)) for run in runs])
    jacobian = np.sin(np.arange(len(residual)))[:, None]
    return evaluation_of_runs(runs, residual, jacobian=jacobian, names=("slope",), model=SWIMMER)


def test_noise_alone_is_adequate_in_every_regime():
    """In thirty draws of correlated noise no regime is accused."""
    assert all(goodness_of_fit(_evaluation(seed), NOISE).adequate for seed in range(30))


@pytest.mark.parametrize(
    ("regime", "missed"),
    [
        ("5500 V", lambda run: 0.009 * np.sin(40 * TIME) if "5500V" in run.name else 0.0),
        ("frequency 4 Hz", lambda run: 0.009 * np.sin(40 * TIME) if "_4Hz" in run.name else 0.0),
        ("side lower", lambda run: 0.009 * np.sin(40 * TIME) * (run.schedule.at(TIME)[:, 1] > 0)),
    ],
)
def test_a_law_that_fails_in_one_regime_is_not_adequate(regime, missed):
    """It is told where, though the whole may be near the noise."""
    found = goodness_of_fit(_evaluation(0, missed), NOISE)
    assert not found.adequate
    assert regime in [lack.regime for lack in found.lacking]
    assert "does not describe these runs yet" in str(found)


WHITE = NoiseModel(white=9e-6, coloured=0.0, correlation=0.5)
CONDITIONS = [(voltage, frequency) for voltage in (3500.0, 4500.0, 5500.0) for frequency in (0.5, 2.0, 3.5)]
EFFECT, SIZE, VALUE = "viscoelastic_creep", "viscoelastic_creep.modulus_ratio", 0.25


def box_run(voltage, frequency, time):
    """One muscle after the other."""
    switches = np.arange(0.0, time[-1], 0.5 / frequency)
    upper = np.arange(len(switches))[:, None] % 2 == [[0, 1]]
    return Run("run", time, DriveSchedule(switches, np.where(upper, voltage, 0.0)))


RUNS = [
    box_run(voltage, frequency, np.arange(0, 2 / frequency, 1 / 120.0)) for voltage, frequency in CONDITIONS
]
ALIKE = [box_run(3500.0, 3.5, run.time) for run in RUNS]
NUMBERS = np.repeat(np.arange(len(RUNS)), [len(run.time) for run in RUNS])
TIME_OF_RUNS = np.concatenate([run.time for run in RUNS])
VOLTAGE, FREQUENCY = np.array(CONDITIONS)[NUMBERS].T


def fitted(growth, by=VOLTAGE, runs=RUNS, at_bound=(), by_finer_mesh=0.0):
    """A fit to a creep whose true size grows by `growth` from the low to the high end of `by`.

    by_finer_mesh: what a finer mesh would do looks like a growth by so much.
    """
    own = np.sin(2 * np.pi * FREQUENCY * TIME_OF_RUNS) * VOLTAGE / 4500.0
    other = np.cos(2 * np.pi * FREQUENCY * TIME_OF_RUNS)
    along = (np.log(by) - np.log(by).min()) / np.log(by.max() / by.min()) - 0.5
    noise = np.random.default_rng(0).normal(scale=0.003, size=len(own))
    jacobian = np.column_stack([other, own])
    measured = VALUE * (1 + growth * along) * own + noise
    change, *_ = np.linalg.lstsq(jacobian, measured - VALUE * own, rcond=None)
    model = load_model("swimmer").with_effects(EFFECT).with_values({SIZE: VALUE + change[1]})
    evaluation = evaluation_of_runs(
        runs,
        measured - VALUE * own - jacobian @ change,
        jacobian=jacobian,
        names=("slope", SIZE),
        model=model,
    )
    refined = {"mesh": VALUE * by_finer_mesh * along * own}
    return FittedModel(model, evaluation, at_bound, (), 1, "made up", changes_by_refinement=refined)


def test_a_value_that_grows_with_voltage_contradicts_the_law():
    """The ends of the trend are the true values there, and the sentence names them."""
    by_voltage, by_frequency = trends(fitted(0.4), WHITE, [EFFECT])
    assert by_voltage.values == pytest.approx((0.8 * VALUE, 1.2 * VALUE), rel=0.02)
    assert by_voltage.contradicts and not by_frequency.contradicts
    assert "at 3500 V and" in str(by_voltage) and "at 5500 V: something" in str(by_voltage)


def test_a_value_that_falls_with_frequency_contradicts_it_too():
    """From 0.5 Hz to 3.5 Hz."""
    by_voltage, by_frequency = trends(fitted(-0.6, FREQUENCY), WHITE, [EFFECT])
    assert by_frequency.contradicts and not by_voltage.contradicts
    assert by_frequency.ends == pytest.approx((0.5, 3.5), rel=0.02)


@pytest.mark.parametrize("growth", [0.0, 0.1])
def test_noise_and_trifles_do_not(growth):
    """One value, and a trend that is certain but small."""
    assert not any(trend.contradicts for trend in trends(fitted(growth), WHITE, [EFFECT]))


def test_runs_that_are_all_alike_tell_nothing():
    """One voltage and one frequency: no trend. Nor is there one for what was not added."""
    assert trends(fitted(0.4, runs=ALIKE), WHITE, [EFFECT]) == []
    assert trends(fitted(0.4), WHITE, ["tether"]) == []


def test_what_stands_on_a_bound_has_no_trend():
    """Beyond a bound there is no law that could be contradicted; the same growth inside is one."""
    assert any(trend.contradicts for trend in trends(fitted(1.0), WHITE, [EFFECT]))
    assert trends(fitted(1.0, at_bound=(SIZE,)), WHITE, [EFFECT]) == []


def test_what_a_finer_mesh_would_take_away_contradicts_no_law():
    """A growth by 40 % that the model's own mesh makes is its error; where that makes 5 %, 40 % are no mesh's."""
    assert any(trend.contradicts for trend in trends(fitted(0.4, by_finer_mesh=0.05), WHITE, [EFFECT]))
    assert not any(trend.contradicts for trend in trends(fitted(0.4, by_finer_mesh=0.4), WHITE, [EFFECT]))


def test_what_a_finer_mesh_would_do_is_one_standard_error():
    """It adds to that by noise as squares, to the trend with voltage only, and moves no value."""
    alone, _ = trends(fitted(0.4), WHITE, [EFFECT])
    by_voltage, by_frequency = trends(fitted(0.4, by_finer_mesh=0.3), WHITE, [EFFECT])
    assert by_voltage.standard_error == pytest.approx(np.hypot(alone.standard_error, 0.3 * VALUE), rel=0.02)
    assert by_frequency.standard_error < 0.5 * by_voltage.standard_error
    assert by_voltage.values == alone.values
