# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The drive of a running simulation."""

import numpy as np
from hasel_sim.drive.chain import DriveChain
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.live.histories import DriveHistory
from hasel_sim.model import load_model

HALF_PERIOD_S, STEPS_PER_SECOND = 0.11, 240


def test_a_lag_that_passes_its_onset_is_followed_as_in_the_whole_run():
    """Step by step: what is found of the past is kept, and is what the whole run's evaluation finds."""
    model = load_model("swimmer").with_levels([3500.0, 4500.0, 5500.0]).with_effects("charging_lag")
    model = model.with_values(
        {
            "amplitude_3500": 0.0316,
            "amplitude_4500": 0.0502,
            "amplitude_5500": 0.0699,
            "charging_lag.charge_time": 0.02,
            "charging_lag.discharge_time": 0.05,
        }
    )
    switches = HALF_PERIOD_S * np.arange(8)
    drive = np.array([[4500.0, 0.0], [0.0, 4500.0]] * 4)
    steps = np.arange(1, int(8 * HALF_PERIOD_S * STEPS_PER_SECOND)) / STEPS_PER_SECOND
    history, live, switch = DriveHistory(model, 10.0, 0.0), [], 0
    for step in steps:
        while switch < len(switches) and switches[switch] < step:
            history.hold(switches[switch], drive[switch])
            switch += 1
        live.append(history.advance(np.array([step]))[1][0])
    whole = DriveChain(model).contraction(
        DriveSchedule(switches, drive), np.concatenate([[0.0], steps]), model.values, model.effect_values()
    )
    assert np.abs(live - whole[1:]).max() < 1e-7
    assert np.ptp(whole, axis=0).min() > 0.02
