# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What no model has, as a reason to leave a small effect out."""

import numpy as np
import pytest
from hasel_sysid.candidates import effects_of
from hasel_sysid.estimation.fit import fit_baseline
from hasel_sysid.policy import POLICY
from hasel_sysid.selection.likelihood import NOTHING
from hasel_sysid.selection.search import Search
from hasel_sysid.testing.made_up_world import MadeUpWorld


@pytest.mark.parametrize(("stranger", "described"), [(0.0, True), (0.006, False)])
def test_it_excuses_only_a_model_that_describes_its_runs(stranger, described):
    """A change below the discrepancy is excused where the runs are described without it; a larger one nowhere."""
    world = MadeUpWorld(1, shared=16)
    problem = world.measured(world.with_typical(), stranger=stranger, strange_at=4500.0)
    baseline = fit_baseline(problem, world.model)
    search = Search(problem, baseline, effects_of(baseline.model, ("payload",)), POLICY, lambda *_: True)
    assert search.excused(NOTHING, np.full(10, 0.5 * problem.discrepancy)) == described
    assert not search.excused(NOTHING, np.full(10, 2.0 * problem.discrepancy))
