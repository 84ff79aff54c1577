"""Numbers as a reader wants them."""

import math

_NORMAL_95 = 1.96


def error_text(error: float) -> str:
    """An error of sin theta: four decimals, or two digits where these would say nothing."""
    return f"{error:.4f}" if error >= 0.0005 or error == 0 else f"{error:.1e}"


def change_text(change: float) -> str:
    """A change of such an error, with its sign."""
    return ("+" if change > 0 else "−") + error_text(abs(change))


def count_text(count: int, what: str) -> str:
    """A count with its noun, such as 1 run or 3 runs."""
    return f"{count} {what}" if count == 1 else f"{count} {what}s"


def percent(share: float) -> str:
    """A share from 0 to 1 as per cent; a dash when not known."""
    if not math.isfinite(share):
        return "–"
    if 0 < share < 0.0005:
        return "< 0.1 %"
    return f"{100 * share:.0f} %" if share >= 0.0095 or share == 0 else f"{100 * share:.1f} %"


def interval_text(value: float, error: float | None, unit: str) -> str:
    """A value with its unit and its 95 % interval: "0.0624 s (95 % interval 0.0602 to 0.0646)"."""
    suffix = "" if unit == "1" else f" {unit}"
    if error is None or not math.isfinite(error) or error <= 0:
        return f"{value:.4g}{suffix}"
    digits = max(0, 1 - math.floor(math.log10(error)))
    interval = (value, value - _NORMAL_95 * error, value + _NORMAL_95 * error)
    middle, low, high = (f"{each:.{digits}f}" if digits <= 7 else f"{each:.4g}" for each in interval)
    return f"{middle}{suffix} (95 % interval {low} to {high})"
