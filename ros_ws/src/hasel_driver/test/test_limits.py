"""Clipping of commands."""

import math

import pytest
from hasel_driver.errors import LimitError
from hasel_driver.limits import clip
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


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_no_number_is_an_error(bad):
    """NaN and infinity are refused instead of guessed at."""
    with pytest.raises(LimitError, match="not finite"):
        clip((0.0, bad), 1000.0)
