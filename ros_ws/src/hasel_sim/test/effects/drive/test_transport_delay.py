# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Transport delay."""

import numpy as np
import pytest


def test_everything_happens_later_and_nothing_else_changes(coarse_swimmer, coarse_baseline, sin_theta_of):
    """A delay of three frames moves the whole angle series by three frames."""
    model = coarse_swimmer.with_effects("transport_delay").with_values({"transport_delay.delay": 3 / 120})
    delayed = sin_theta_of(model)
    assert delayed[3:] == pytest.approx(coarse_baseline[:-3], abs=1e-9)
    assert np.abs(delayed[:4]).max() < 1e-9
