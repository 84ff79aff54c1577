# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Values with their standard errors."""

import pytest
from hasel_sim.parameter import Parameter, value_with_error


@pytest.mark.parametrize(
    ("value", "error", "unit", "text"),
    [
        (0.062431, 0.00112, "1", "0.0624 ± 0.0011"),
        (0.26412, 0.0123, "1/s", "0.264 ± 0.012 1/s"),
        (123456.0, 2345.0, "Pa", "123456 ± 2345 Pa"),
        (0.25, None, "1", "0.25"),
        (0.25, float("inf"), "s", "0.25 s"),
        (float("nan"), 0.1, "s", "–"),
    ],
)
def test_value_with_error(value, error, unit, text):
    """Digits follow the standard error; the unit 1 is not written."""
    assert value_with_error(value, error, unit) == text


def test_a_parameter_is_written_to_the_digits_of_its_standard_error():
    """No digit that the fit does not know."""
    fitted = Parameter("amplitude_3500", 0.00895211, "1", 0.0, 0.6, standard_error=0.000503)
    assert str(fitted) == "amplitude_3500 = 0.00895 ± 0.00050"
    assert str(Parameter("slope", 0.264, "1/s", 0.0, 50.0)) == "slope = 0.264 1/s"
