# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A coarse swimmer in oil."""

import pytest
from hasel_sim.model import Model, load_model


@pytest.fixture(scope="session")
def fish() -> Model:
    """The swimmer in oil on a coarse mesh."""
    return load_model("swimmer_in_oil").with_numerics(mesh_density=0.5, steps_per_second=120.0)
