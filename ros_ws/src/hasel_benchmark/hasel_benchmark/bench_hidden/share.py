"""How well a share is known from so many cases."""

from math import sqrt

NORMAL_95 = 1.96
"""Standard deviations of a normal distribution within which 95 % lie."""


def wilson_interval(share: float, count: int) -> tuple[float, float]:
    """In which the true share lies with 95 %, from the share of `count` cases (Wilson 1927)."""
    z = NORMAL_95
    middle = (share + z**2 / (2 * count)) / (1 + z**2 / count)
    half = z / (1 + z**2 / count) * sqrt(share * (1 - share) / count + z**2 / (4 * count**2))
    return max(middle - half, 0.0), min(middle + half, 1.0)
