# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Charging lag."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp


def _step(time, at, size):
    return np.stack([np.where(time >= at, size, 0.0)] * 2, axis=1)


def test_63_per_cent_after_one_time_constant(response):
    """After one charge time the voltage is 1 - 1/e of the command; after one discharge time of 0 V, 1/e."""
    time = np.array([0.0, 0.1, 0.1, 0.17, 5.0, 5.0, 5.03])
    command = np.array([0.0, 0.0, 5e3, 5e3, 5e3, 0.0, 0.0])[:, None] * np.ones(2)
    found = response("charging_lag", time, command, charge_time=0.07, discharge_time=0.03)[:, 0]
    assert found[3] == pytest.approx(5e3 * (1 - np.exp(-1)))
    assert found[6] == pytest.approx(5e3 * np.exp(-1))


def test_the_step_of_the_grid_does_not_matter(response):
    """A coarse grid gives exactly what a fine one gives."""
    fine = np.linspace(0.0, 1.0, 1001)
    found = response("charging_lag", fine, _step(fine, 0.0, 3e3), charge_time=0.05)
    coarse = response("charging_lag", fine[::100], _step(fine[::100], 0.0, 3e3), charge_time=0.05)
    assert coarse[1:] == pytest.approx(found[100::100], rel=1e-3)


def test_a_reversed_polarity_discharges_before_it_charges(response):
    """From +V to -V the voltage is zero after the discharge time times ln 2, then charges with the charge time."""
    zero = 0.2 * np.log(2)
    time = np.array([0.0, 0.0, 9.0, 9.0, 9.0 + zero, 9.0 + zero + 0.05])
    command = np.array([0.0, 4e3, 4e3, -4e3, -4e3, -4e3])[:, None] * np.ones(2)
    found = response("charging_lag", time, command, charge_time=0.05, discharge_time=0.2)[:, 1]
    assert found[4] == pytest.approx(0.0, abs=1e-6)
    assert found[5] == pytest.approx(-4e3 * (1 - np.exp(-1)))
    whole = response(
        "charging_lag",
        np.delete(time, 4),
        np.delete(command, 4, axis=0),
        charge_time=0.05,
        discharge_time=0.2,
    )
    assert whole[-1] == pytest.approx(found[-1][None].repeat(2), rel=1e-9)


def test_a_ramp_agrees_with_an_ode_solver(response):
    """Between its times a signal may change steadily."""
    time = np.linspace(0.0, 0.5, 26)
    ramp = 8e3 * time[:, None] * np.ones(2)
    found = response("charging_lag", time, ramp, charge_time=0.08)[:, 0]
    exact = solve_ivp(
        lambda t, v: (8e3 * t - v) / 0.08, (0.0, 0.5), [0.0], t_eval=time, rtol=1e-9, atol=1e-9
    ).y[0]
    assert found == pytest.approx(exact, abs=1e-3)


def test_an_instant_charge_with_a_slow_discharge(response):
    """Each time constant may be zero on its own."""
    time = np.array([0.0, 0.0, 1.0, 1.0, 1.1])
    command = np.array([0.0, 5e3, 5e3, 0.0, 0.0])[:, None] * np.ones(2)
    found = response("charging_lag", time, command, discharge_time=0.1)[:, 0]
    assert found == pytest.approx([0.0, 5e3, 5e3, 5e3, 5e3 * np.exp(-1)])
