"""What `print(h.improve(...))` says."""

import numpy as np
from hasel_sim.model import load_model
from hasel_sysid.api import Improved
from hasel_sysid.result import Improvement, Stage, Status
from hasel_sysid.testing.made_up_runs import made_up_fit


def test_sizes_and_intervals_are_printed_as_by_the_command():
    """Of what was found missing, and of nothing else."""
    name = "quadratic_drag.coefficient"
    baseline = load_model("swimmer").with_levels(np.array([4500.0]))
    drag = baseline.with_effects("quadratic_drag").with_values({name: 0.25}, {name: 0.01})
    stages = [
        Stage((), made_up_fit(baseline, 0.03), None),
        Stage(("quadratic_drag",), made_up_fit(drag, 0.003), None),
    ]
    found = Improved(
        Improvement(stages, Status.EXPLAINED, ("quadratic_drag",), 0.02, 0.002, "What is left is noise.")
    )
    said = str(found).splitlines()
    assert said[-1] == f"  {name} = 0.250 (95 % interval 0.230 to 0.270)"
    assert len([line for line in said if " = " in line]) == 1
