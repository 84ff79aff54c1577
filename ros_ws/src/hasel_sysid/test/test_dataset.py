"""Recordings as experiments."""

import numpy as np
from hasel_recording import Recording
from hasel_sysid.dataset import drive_levels
from hasel_sysid.experiment import experiment_of


def _runs(*levels: float):
    """One run per level, each held for a second."""
    time = np.arange(120) / 120
    return [
        experiment_of(Recording(f"run{level}", time, np.zeros(120), np.tile([level, 0.0], (120, 1))))
        for level in levels
    ]


def test_one_voltage_measured_in_several_runs_has_one_amplitude():
    """3499.6, 3500.2 and 3500.9 V are one level with the roundest number among them; 3600 V is another."""
    np.testing.assert_allclose(drive_levels(_runs(3499.6, 3500.2, 3500.9, 3600.0)), [3500.0, 3600.0])


def test_commanded_levels_stay_as_they_are():
    """Every commanded voltage keeps its own number."""
    np.testing.assert_allclose(drive_levels(_runs(4567.0, 3501.0, 5500.0)), [3501.0, 4567.0, 5500.0])


def test_a_fine_ramp_is_not_one_level():
    """Many levels, each near the next, are spread over their range."""
    assert len(drive_levels(_runs(*np.arange(3000.0, 5500.0, 12.0)))) == 8
