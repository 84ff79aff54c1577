"""Values as a reader wants them."""

import math


def value_with_error(value: float, error: float | None, unit: str) -> str:
    """A value with its standard error, rounded to two digits of the error: "0.0624 ± 0.0011"."""
    suffix = "" if unit == "1" else f" {unit}"
    if not math.isfinite(value):
        return "–"
    if error is None or not math.isfinite(error) or error <= 0:
        return f"{value:.4g}{suffix}"
    digits = 1 - math.floor(math.log10(error))
    if digits > 7 or digits < -3:
        return f"{value:.4g} ± {error:.2g}{suffix}"
    return f"{value:.{max(digits, 0)}f} ± {error:.{max(digits, 0)}f}{suffix}"
