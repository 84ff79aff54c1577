# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Clipping of commands."""

import math

import pytest
from hasel_driver.protocol.faults import LimitError
from hasel_driver.protocol.limits import Limits, clip
from hypothesis import given
from hypothesis import strategies as st

VOLTAGE = st.floats(allow_nan=False, allow_infinity=False)


@given(VOLTAGE, VOLTAGE, st.floats(0, 10_000), st.booleans())
def test_always_within_the_limit(upper, lower, maximum, bipolar):
    """No finite command leaves the range, and one inside it is not changed."""
    clipped = clip((upper, lower), maximum, bipolar)
    least = -maximum if bipolar else 0.0
    for before, after in zip((upper, lower), clipped, strict=True):
        assert least <= after <= maximum
        assert after == before or not least <= before <= maximum


@pytest.mark.parametrize("voltages", [(), (1.0,), (1.0, 2.0, 3.0)])
def test_another_number_of_voltages_is_an_error(voltages):
    """There is one for each muscle; which one is missing must not be guessed at."""
    with pytest.raises(LimitError, match=rf"{len(voltages)} voltages .* expected 2 \(upper, lower\)"):
        clip(voltages, 1000.0)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_no_number_is_an_error(bad):
    """NaN and infinity are refused instead of guessed at."""
    with pytest.raises(LimitError, match="not finite"):
        clip((0.0, bad), 1000.0)


def test_the_sum_of_silence_dead_time_and_discharge_is_limited():
    """Each within its range, 0.45 s, 0.05 s and 4.5 nF are more than half a second to ground; the defaults are not."""
    Limits(load_f=4.5e-9).check_sum()
    with pytest.raises(LimitError, match=r"0\.51. s in all"):
        Limits(heartbeat_s=0.45, dead_time_s=0.006, load_f=4.5e-9).check_sum()  # 0.499 s, and the wire
    with pytest.raises(LimitError, match=r"0\.56. s in all"):
        Limits(maximum_voltage_v=9800.0, heartbeat_s=0.45, dead_time_s=0.05, load_f=4.5e-9).check_sum()
