"""Sizes over the decades of a plausible range."""

import numpy as np
import pytest
from hasel_sim.effects.registry import catalogue
from hasel_sysid.estimation.decades import over_range


def test_a_mass_is_tried_from_below_its_typical_size_to_the_heaviest():
    """A thousandfold range in half decades; what is far from the truth by typical sizes may be a third of one."""
    sizes = over_range(0.0, 0.01, 0.0, 10.0)
    assert sizes[0] == pytest.approx(0.01 / 10**0.5) and 3.0 < sizes[-1] < 10.0
    assert np.diff(np.log10(sizes)) == pytest.approx(0.5)


def test_a_scale_is_tried_below_and_above_one():
    """Evenly in its logarithm, within its range."""
    sizes = over_range(1.0, 1.2, 0.3, 3.0)
    assert min(sizes) < 0.5 and max(sizes) > 2.0
    assert np.ptp(np.diff(np.log(sizes))) < 1e-9


def test_a_signed_size_is_tried_to_either_side():
    """No size is zero, none outside the range."""
    sizes = over_range(0.0, 0.1, -0.5, 0.5)
    assert min(sizes) == -max(sizes)
    assert 0.0 not in sizes


@pytest.mark.parametrize("effect", catalogue().values(), ids=list(catalogue()))
def test_no_size_of_any_effect_leaves_its_range(effect):
    """And there is at least one."""
    first = next((p for p in effect.parameters if not p.scan), effect.parameters[0])
    sizes = over_range(first.null, first.typical, first.lower, first.upper)
    assert sizes and all(first.lower <= size <= first.upper for size in sizes)
