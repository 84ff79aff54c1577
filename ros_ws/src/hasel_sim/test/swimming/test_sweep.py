"""Sweeps: side by side, in a file, broken off and taken up again."""

import numpy as np
import pytest
from hasel_sim.errors import ModelError
from hasel_sim.parallel import SerialExecutor
from hasel_sim.swimming.boxes import Boxes
from hasel_sim.swimming.free_swim import free_swim
from hasel_sim.swimming.sweep import SweepLedger, fingerprint, sweep, swim_together

DRIVES = [Boxes(5500.0, 5500.0, f) for f in (2.0, 2.5, 3.0)]
DURATION = 2.0


@pytest.fixture(scope="module")
def swam(fish):
    """The three swims at once."""
    return sweep(SerialExecutor(), fish, DRIVES, DURATION)


def test_side_by_side_as_alone(fish, swam):
    """Each comes out as by itself, in the order asked for."""
    assert [one.drive for one in swam] == DRIVES
    alone = free_swim(fish, DRIVES[1].run(fish, DURATION), 2.5)
    assert swam[1].speed_m_per_s == pytest.approx(alone.speed, rel=1e-6)
    assert swam[1].power_w == pytest.approx(alone.power, rel=1e-6)


def test_goes_on_where_it_was_broken_off(tmp_path, fish, swam, monkeypatch):
    """What the file has whole is not swum again, a line cut in the middle is; the file then has all."""
    path = tmp_path / "deep" / "swim.csv"
    SweepLedger(path, fish, DURATION).add(swam[:2])
    path.write_text(path.read_text()[:-9])
    asked = []

    def counting(model, drives, duration):
        asked.extend(drives)
        return swim_together(model, drives, duration)

    monkeypatch.setattr("hasel_sim.swimming.sweep.swim_together", counting)
    counts = []
    found = sweep(SerialExecutor(), fish, DRIVES, DURATION, SweepLedger(path, fish, DURATION), counts.append)
    assert asked == DRIVES[1:]
    assert (counts[0], counts[-1]) == (1, 3)
    assert set(SweepLedger(path, fish, DURATION).known) == set(DRIVES)
    assert np.allclose([one.speed_m_per_s for one in found], [one.speed_m_per_s for one in swam])


def test_another_models_file_is_refused(tmp_path, fish):
    """Numbers of two models do not get into one table; another name is no other model."""
    SweepLedger(tmp_path / "swim.csv", fish, DURATION)
    heavier = fish.with_values({"reactive_force.coefficient": 1.2})
    for model, duration in ((heavier, DURATION), (fish, 3.0)):
        with pytest.raises(ModelError, match="holds swims of another model or duration"):
            SweepLedger(tmp_path / "swim.csv", model, duration)
    assert fingerprint(fish) != fingerprint(heavier)
