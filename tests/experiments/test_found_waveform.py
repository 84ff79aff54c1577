# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A waveform that the simulator found is one that the driver plays."""

import numpy as np
import pytest
from hasel_driver.nodes.experiment_goal import read_waveform
from hasel_sim.swimming.boxes import Boxes, waveform_rows


def test_the_driver_plays_what_was_found(tmp_path):
    """Its file is read as a waveform of RunExperiment, with the same voltages at the same times, and ends at rest."""
    drive = Boxes(5169.55, 5500.0, 1.5, duty=0.9, phase=0.48)
    (tmp_path / "found.csv").write_text(waveform_rows(drive, 4.0, ("upper", "lower")))
    waveform = read_waveform(tmp_path / "found.csv")
    assert waveform.duration_s == 4.0
    schedule = drive.schedule(4.0, ("upper", "lower"))
    for time in np.arange(0.01, 4.0, 0.0371):
        assert waveform.voltage(time) == pytest.approx(tuple(schedule.at(np.array([time]))[0]))
