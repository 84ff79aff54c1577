from dataclasses import replace

import numpy as np


def test_prints_as_a_sentence(driven):
    """A run says how long it is, how fast, how strongly driven and how far it bends."""
    assert str(driven) == "driven: 240 frames in 1.99 s (120 frames/s), up to 3500 V, |sin θ| up to 0.1"


def test_lost_frames_are_counted(driven):
    """Frames without an angle are named and do not spoil the extremes."""
    run = replace(driven, sin_theta=np.where(np.arange(240) < 2, np.nan, driven.sin_theta))
    assert "2 without an angle" in str(run)
    assert run.valid.sum() == 238


def test_drive_prefers_the_exact_instants(driven):
    """The drive is the instants of switching where they are known, else the frames."""
    assert driven.drive()[0] is driven.time_s
    run = replace(driven, drive_time_s=np.array([0.1]), drive_voltage=np.array([[1.0, 2.0]]))
    assert run.drive()[0].tolist() == [0.1]
