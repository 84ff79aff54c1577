# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import pytest
from hasel_sim.muscle.pouch import Pouch


@pytest.fixture
def pouch():
    """A pouch of 20 mm, half of it under electrodes, filled for full zipping."""
    return Pouch(0.020, 0.010, 0.050, 18e-6, 3.15)
