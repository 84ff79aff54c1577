# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Every component is found with its true size, and no other one is blamed."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_recording import DriveChannel
from hasel_sysid.residual_analysis.analysis import analyse_run
from hasel_sysid.residual_analysis.component import Kind
from hasel_sysid.residual_analysis.run_series import RunSeries
from hasel_sysid.residual_analysis.split import half_wave_asymmetry, split
from hasel_sysid.residual_analysis.swing import fit_swing


def _component(run, kind):
    return next(c for c in split(run) if c.kind is kind)


def test_lag_is_found_to_a_millisecond(made_run):
    """A measured series 35 ms late has a lag of 35 ms, clear and largest."""
    run = made_run(lambda time, simulated, truth: truth(time - 0.035))
    lag = _component(run, Kind.LAG)
    assert lag.value == pytest.approx(0.035, abs=0.001)
    assert lag.significance > 10
    assert split(run)[0].kind is Kind.LAG


def test_gain_is_found(made_run):
    """Twelve per cent less motion is a gain of -0.12."""
    gain = _component(made_run(lambda time, simulated, truth: 0.88 * simulated), Kind.GAIN)
    assert gain.value == pytest.approx(-0.12, abs=4 * gain.standard_error)
    assert gain.standard_error < 0.01


def test_offset_is_found(made_run):
    """A constant difference is an offset and nothing else."""
    run = made_run(lambda time, simulated, truth: simulated + 0.02)
    assert _component(run, Kind.OFFSET).value == pytest.approx(0.02, abs=0.001)
    assert analyse_run(run).failures == ()


def test_weaker_lower_side_is_found(made_run):
    """Where the response to the lower side is scaled by 0.8, the lower side is 20 % less than the upper."""
    run = made_run(lambda time, simulated, truth: np.where(simulated > 0, simulated, 0.8 * simulated))
    side = _component(run, Kind.UPPER_AGAINST_LOWER)
    assert side.value == pytest.approx(-0.2, abs=0.02)
    assert side.detail["half_wave_asymmetry"] > 3 * 0.002 / np.sqrt(2)


def test_a_body_driven_one_way_has_no_sides(made_run):
    """With one chamber alone a difference of the sides means nothing, whatever the motion about its mean."""
    run = made_run(lambda time, simulated, truth: np.where(simulated > 0, simulated, 0.8 * simulated))
    chamber = (DriveChannel("chamber", "pressure", "Pa"),)
    one_way = replace(run, drive_values=run.drive_values[:, :1], channels=chamber)
    assert Kind.UPPER_AGAINST_LOWER not in {component.kind for component in split(one_way)}


def test_slower_return_is_found(made_run):
    """A series that comes back 20 ms later than it bends away has a negative rise against fall of 20 ms."""

    def change(time, simulated, truth):
        away = np.sign(simulated * np.gradient(simulated, time))
        return simulated - np.gradient(simulated, time) * np.where(away < 0, 0.020, 0.0)

    rise = _component(made_run(change), Kind.RISE_AGAINST_FALL)
    assert rise.value == pytest.approx(-0.020, abs=0.003)
    assert rise.detail["fall_lag_s"] == pytest.approx(0.020, abs=0.004)


def test_ringing_is_found_with_its_frequency(made_run):
    """A damped 6 Hz swing after every switch is found with frequency and amplitude."""

    def change(time, simulated, truth):
        since, side = np.mod(time, 1.0), np.where(np.mod(time, 2.0) < 1.0, 1, -1)
        return simulated + 0.03 * side * np.exp(-3 * since) * np.sin(2 * np.pi * 6 * since)

    ringing = _component(made_run(change, frequency=0.5, periods=2), Kind.RINGING)
    assert ringing.detail["frequency_hz"] == pytest.approx(6.0, rel=0.08)
    assert ringing.value == pytest.approx(0.03, rel=0.25)


def test_fading_is_found(made_run):
    """Motion that fades by 10 % per second has that drift of the gain."""
    run = made_run(lambda time, simulated, truth: simulated * (1 - 0.1 * (time - time.mean())), periods=8)
    assert _component(run, Kind.GAIN_DRIFT).value == pytest.approx(-0.1, abs=0.01)


def test_wandering_is_found(made_run):
    """A base line that rises by 0.01 per second has that drift of the offset."""
    run = made_run(lambda time, simulated, truth: simulated + 0.01 * time, periods=8)
    assert _component(run, Kind.OFFSET_DRIFT).value == pytest.approx(0.01, abs=0.001)


@pytest.mark.parametrize("frequency", [0.5, 2.0, 3.5])
def test_noise_alone_is_no_failure(made_run, frequency):
    """Noise, white or correlated, that is all that is different is not reported, in 60 runs."""
    reported = 0
    for seed in range(20):
        rng = np.random.default_rng(1000 + seed)

        def coloured(time, simulated, truth, rng=rng):
            noise, level = np.zeros(len(time)), 0.0
            for n, kick in enumerate(rng.normal(size=len(time))):
                level = 0.8 * level + 0.6 * kick
                noise[n] = 0.0015 * level
            return simulated + noise

        reported += len(analyse_run(made_run(coloured, frequency=frequency, periods=2, seed=seed)).failures)
    assert reported <= 1


def test_half_wave_asymmetry_between_frames():
    """A symmetric series has none at 3.5 Hz, where half a period is 17.14 frames; an even harmonic shows fully."""
    time = np.arange(0, 2, 1 / 120)
    odd = np.sin(2 * np.pi * 3.5 * time) + 0.3 * np.sin(2 * np.pi * 10.5 * time)
    assert half_wave_asymmetry(time, odd, 1 / 3.5) < 1e-3
    even = odd + 0.1 * np.cos(2 * np.pi * 7 * time)
    assert half_wave_asymmetry(time, even, 1 / 3.5) == pytest.approx(0.1 / np.sqrt(2), rel=0.02)


def test_swing_of_a_passive_body():
    """Frequency and damping ratio of a swing agree with theory, and a passive run names their differences."""
    time, rng = np.arange(0, 2, 0.01), np.random.default_rng(0)

    def swing(hertz, ratio):
        omega = 2 * np.pi * hertz
        return 0.1 * np.exp(-ratio * omega * time) * np.cos(omega * np.sqrt(1 - ratio**2) * time)

    measured = swing(5.0, 0.05) + 1e-4 * rng.normal(size=len(time))
    fitted = fit_swing(time, measured)
    assert fitted.damping_ratio == pytest.approx(0.05, abs=1e-3)
    run = RunSeries("beam", time, measured, swing(5.5, 0.0))
    frequency, decay = _component(run, Kind.SWING_FREQUENCY), _component(run, Kind.SWING_DECAY)
    assert frequency.value == pytest.approx(5.0 / 5.5 - 1, abs=0.002)
    assert decay.value == pytest.approx(0.05 * 2 * np.pi * 5.0, rel=0.02)
    assert any("damping ratio 0.05 against" in str(f) for f in analyse_run(run).failures)


def test_too_short_a_run_says_nothing():
    """Fewer than 16 frames have no components."""
    time = np.arange(10) / 120
    assert split(RunSeries("short", time, time, 0 * time)) == ()
