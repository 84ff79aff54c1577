"""How near a model must be for its derivatives to be followed."""

import numpy as np
from hasel_sysid.estimation import is_close


def test_a_model_is_close_while_its_error_is_a_seventh_of_the_motion():
    """Whatever the unit."""
    motion = np.sin(np.arange(100.0))
    assert is_close(0.14 * motion, motion)
    assert not is_close(0.16 * motion, motion)
    assert is_close(1e6 * 0.14 * motion, 1e6 * motion)
