# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What is heard of a rig becomes samples to draw, a running error, and recordings to fit."""

import numpy as np
import pytest
from hasel_recording import read_recording
from hasel_sysid.errors import SysidError
from hasel_workbench.live.stream import LiveStream


def _fed(frames: int = 240, gain: float = 0.8) -> LiveStream:
    """A stream of two seconds: a box drive, a measured swing and a simulated one of another size."""
    stream = LiveStream()
    for number in range(frames):
        stamp = 5_000_000_000 + round(number * 1e9 / 120)
        upper = 4000.0 if number >= 30 and (number // 30) % 2 else 0.0
        stream.voltage(stamp, (upper, 0.0))
        swing = 0.2 * np.sin(2 * np.pi * number / 60)
        stream.measured(stamp, swing)
        stream.simulated(stamp, gain * swing)
    return stream


def test_samples_come_once():
    """What was seen does not come again; each has its time since the first one [s] and its value."""
    stream = _fed()
    first = stream.since({})
    assert {kind: len(rows) for kind, rows in first.items()} == dict.fromkeys(first, 240)
    assert first["measured"][60][0] == pytest.approx(0.5)
    assert first["voltage"][40].tolist() == pytest.approx([40 / 120, 4000.0, 0.0])
    seen = dict(stream.count)
    assert all(len(rows) == 0 for rows in stream.since(seen).values())
    stream.measured(8_000_000_000, 0.1)
    assert len(stream.since(seen)["measured"]) == 1


def test_the_running_error_is_that_of_the_samples():
    """Mean |Δ sin θ| of a swing simulated a fifth too small: a fifth of its mean magnitude."""
    expected = 0.2 * 0.2 * 2 / np.pi
    assert _fed().error.mean_absolute == pytest.approx(expected, rel=0.02)
    assert _fed(gain=1.0).error.mean_absolute == pytest.approx(0.0, abs=1e-9)


def test_rest_does_not_make_the_error_smaller():
    """A second after its drive the run is over: its error stays until the next one begins."""
    stream = LiveStream()
    errors = []
    for number in range(1740):
        stamp = 5_000_000_000 + round(number * 1e9 / 120)
        driven = 360 <= number < 480 or number >= 1440
        swing = 0.2 * np.sin(2 * np.pi * number / 60) if driven else 0.0
        stream.voltage(stamp, (4000.0 if driven else 0.0, 0.0))
        stream.measured(stamp, swing)
        stream.simulated(stamp, swing * (0.8 if number < 1440 else 0.9))
        errors.append(stream.error.mean_absolute)
    assert errors[300] == 0.0
    assert errors[602] == errors[1439] == pytest.approx(0.5 * 0.2 * 0.2 * 2 / np.pi, rel=0.02)
    assert errors[-1] == pytest.approx(0.1 * 0.2 * 2 / np.pi, rel=0.02)


def test_what_was_heard_is_written_and_can_be_read(tmp_path):
    """One recording per run, in a file, so that nothing that was heard is lost and a script can read it."""
    (recording,) = _fed().recordings(tmp_path)
    again = read_recording(recording.path)
    assert np.nanmax(np.abs(again.sin_theta)) == pytest.approx(0.2, rel=0.01)
    assert again.drive()[1].max() == 4000.0


def test_nothing_heard_is_a_sentence(tmp_path):
    """With what to do."""
    with pytest.raises(SysidError, match="no run was heard so far"):
        LiveStream().recordings(tmp_path)
