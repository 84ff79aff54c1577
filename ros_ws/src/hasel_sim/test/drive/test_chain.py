"""The whole drive from voltage to contraction."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sim.drive.chain import DriveChain
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.effects.base import DriveEffect, DriveStage, EffectParameter
from hasel_sim.effects.drive.charging_lag import ChargingLag
from hasel_sim.model import load_model

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
