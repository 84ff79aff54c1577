"""The waveform that swims best."""

from pathlib import Path

import numpy as np
import pytest
from hasel_sim.errors import SimulationError
from hasel_sim.model import load_model
from hasel_sim.swimming.best_waveform import Task, best_waveform, waveform_rows
from hasel_sim.swimming.boxes import Boxes

ASYMMETRIC = Path(__file__).parents[2] / "docs" / "bodies" / "asymmetric_fish.yaml"
START = Boxes(5000.0, 5000.0, 1.5)


@pytest.fixture(scope="module")
def lopsided():
    """A fish whose lower muscle is a tenth weaker, on a coarse mesh."""
    return load_model(ASYMMETRIC).with_numerics(mesh_density=0.4, steps_per_second=120.0)


def test_unequal_voltages_straighten_an_asymmetric_fish(lopsided):
    """It turns under equal voltages; the weaker muscle gets more, and it swims straight and no slower."""
    found = best_waveform(lopsided, START, Task(turning=0.0, duration=3.0), most=6)
    assert abs(np.degrees(found.start.turning)) > 0.3
    assert abs(np.degrees(found.best.turning)) < 0.02
    assert found.best.drive.second > found.best.drive.first + 100.0
    assert found.best.speed >= found.start.speed
    assert len(found.tried) < 12


def test_the_cheapest_swim_is_not_the_fastest(lopsided):
    """Less work per distance than at the start, at lower voltages; the sentence says what was found."""
    task = Task("cost", duration=3.0)
    found = best_waveform(lopsided, START, task, most=3)
    assert found.best.cost_of_transport < 0.98 * found.start.cost_of_transport
    assert max(found.best.drive.first, found.best.drive.second) < 4500.0
    assert found.best.speed < found.start.speed
    assert "J/(kg m)" in str(found) and "swims with gradients" in str(found)


@pytest.mark.parametrize(
    ("task", "said"),
    [
        ({"goal": "fame"}, "'fame' is no goal; expected one of speed, cost"),
        ({"vary": ("voltage",)}, "'voltage' cannot be varied; expected some of first, second, duty, phase"),
        ({"largest": 4000.0}, "first starts at 1.25; expected 0.4 to 1"),
    ],
)
def test_a_task_that_makes_no_sense_is_refused(lopsided, task, said):
    """An unknown goal, an unknown number, a start above the largest voltage."""
    with pytest.raises(SimulationError, match=said):
        best_waveform(lopsided, START, Task(**task))


def test_the_waveform_as_a_file():
    """A row per switch, each until the next, and rest at the end."""
    lines = waveform_rows(Boxes(5169.67, 5500.0, 2.0), 1.0, ("upper", "lower")).splitlines()
    assert lines[0] == "time_s,voltage_upper_v,voltage_lower_v"
    assert lines[1:] == ["0,5169.67,0", "0.25,0,5500", "0.5,5169.67,0", "0.75,0,5500", "1,0,0"]
