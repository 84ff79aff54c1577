"""The outline of a body: half height along it, and where it leaves no room for the spine."""

import numpy as np


def half_height(coefficients: np.ndarray, largest_half_height: float, s: float | np.ndarray) -> np.ndarray:
    """Half height [m] of the outline at s = x / length, a polynomial in s scaled with the largest half height."""
    return largest_half_height * np.polynomial.polynomial.polyval(s, coefficients)


def outline_fault(
    coefficients: np.ndarray, largest_half_height: float, spine_thickness: float, length: float
) -> str | None:
    """A sentence about where the outline crosses the spine, and so maybe itself; None where it does not."""
    s = np.linspace(0, 1, 401)
    height = half_height(coefficients, largest_half_height, s)
    if np.all(height > 0.5 * spine_thickness):
        return None
    crossed = (
        f"the spine of {1e3 * spine_thickness:.2f} mm"
        if spine_thickness
        else "the centre line, and so itself"
    )
    return (
        f"the outline is {2e3 * height.min():.2f} mm high at x = {1e3 * s[np.argmin(height)] * length:.0f} mm "
        f"and crosses {crossed}; expected a body higher than its spine everywhere: change the outline's "
        "coefficients or the spine's thickness_m"
    )
