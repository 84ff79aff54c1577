"""Numbers as a reader wants them."""

import pytest
from hasel_sysid.report.numbers import (
    change_text,
    count_text,
    error_text,
    interval_text,
    percent,
)


@pytest.mark.parametrize(
    ("value", "error", "unit", "text"),
    [
        (0.0694496, 0.0056, "s", "0.0694 s (95 % interval 0.0585 to 0.0804)"),
        (0.248, 0.003, "1", "0.2480 (95 % interval 0.2421 to 0.2539)"),
        (1200.0, 150.0, "Pa", "1200 Pa (95 % interval 906 to 1494)"),
        (0.5, None, "1/s", "0.5 1/s"),
    ],
)
def test_interval(value, error, unit, text):
    """A value with unit and 95 % interval, to two digits of the standard error."""
    assert interval_text(value, error, unit) == text


def test_percent():
    """Shares in per cent, unknown ones as a dash."""
    assert [percent(share) for share in (0.93, 0.0996, 0.004, 1e-9, 0.0, float("nan"))] == [
        "93 %",
        "10 %",
        "0.4 %",
        "< 0.1 %",
        "0 %",
        "–",
    ]


def test_errors_small_and_large():
    """Errors have four decimals unless these would be zeros; changes have a sign, counts their noun."""
    assert [error_text(error) for error in (0.0259, 0.0, 1.6e-5)] == ["0.0259", "0.0000", "1.6e-05"]
    assert [change_text(change) for change in (-0.0938, 0.002)] == ["−0.0938", "+0.0020"]
    assert [count_text(count, "run") for count in (1, 3)] == ["1 run", "3 runs"]
