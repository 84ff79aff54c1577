# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import pytest
from hasel_sim.parallel import executor


@pytest.fixture(scope="package")
def pool():
    """Two processes, as on the machine that the bars are stated for."""
    with executor(2) as processes:
        yield processes
