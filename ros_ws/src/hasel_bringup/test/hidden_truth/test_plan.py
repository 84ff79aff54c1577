# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
from pathlib import Path

import numpy as np
import pytest
from hasel_bringup.hidden_truth.plan import FITTED, UNSEEN, BoxRun
from hasel_sysid.dataset import load_experiments

RIG = Path(__file__).resolve().parents[5] / "data" / "unseen_rig" / "nothing_hidden"


def test_nine_runs_are_fitted_and_three_unseen():
    """Three voltages at three frequencies, and three other voltages at another frequency."""
    assert {(r.voltage, r.frequency) for r in FITTED} == {
        (v, f) for v in (3500, 4500, 5500) for f in (0.5, 2.0, 3.5)
    }
    assert {(r.voltage, r.frequency) for r in UNSEEN} == {(4250, 2.5), (4800, 2.5), (5200, 2.5)}


@pytest.mark.parametrize("box", [*FITTED, *UNSEEN], ids=lambda box: box.name)
def test_frames_and_drive_are_those_of_the_rig(box):
    """With switches on frames, a run has the rig's frames and, row for row, its voltages."""
    measured = load_experiments([RIG / f"{box.name}.csv"])[0]
    run = box.run(switch_on_frames=True)
    np.testing.assert_allclose(run.time, measured.run.time, atol=1e-6)
    np.testing.assert_array_equal(run.schedule.at(run.time), measured.recording.voltage)


def test_switches_lie_at_true_instants():
    """The drive turns over every half period, between frames where it must."""
    run = BoxRun(4500.0, 3.5).run()
    np.testing.assert_allclose(run.schedule.time, np.arange(5) / 7.0)
    assert run.schedule.signal.tolist() == [[4500, 0], [0, 4500], [4500, 0], [0, 4500], [4500, 0]]
