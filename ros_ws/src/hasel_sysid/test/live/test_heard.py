# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What was heard becomes recordings."""

import numpy as np
import pytest
from hasel_sysid.errors import SysidError
from hasel_sysid.live.heard import DriveWatch, Heard, driven_parts

_FRAME = 8_333_333
_EPOCH_NS = 1_800_000_000_000_000_000


def _run(heard: Heard, epoch: int, start_ns: int, frames: int = 60, voltage: float = 5000.0) -> None:
    for n in range(frames):
        heard.state(epoch, start_ns + n * _FRAME, (voltage if n < 30 else 0.0, 0.0))
        heard.measured(epoch, start_ns + n * _FRAME, 0.01 * n)


def test_a_run_is_given_back_with_its_voltages_and_angles():
    """Times count from the first message, to the nanosecond although stamps are large."""
    heard = Heard(reset=2.0)
    _run(heard, 0, _EPOCH_NS)
    (recording,) = heard.recordings()
    assert np.allclose(recording.time_s, np.arange(60) * _FRAME * 1e-9, rtol=0, atol=1e-12)
    assert recording.sin_theta.tolist() == [0.01 * n for n in range(60)]
    assert recording.voltage[:, 0].tolist() == [5000.0] * 30 + [0.0] * 30


@pytest.mark.parametrize(("epoch", "start"), [(1, _EPOCH_NS), (0, _EPOCH_NS + 10_000_000_000)])
def test_runs_are_kept_apart(epoch, start):
    """Replayed again, or after a pause."""
    heard = Heard(reset=2.0)
    _run(heard, 0, _EPOCH_NS, voltage=4000.0)
    _run(heard, epoch, start, voltage=5000.0)
    assert [recording.voltage.max() for recording in heard.recordings()] == [4000.0, 5000.0]


def test_states_and_frames_with_clocks_of_their_own():
    """Each frame gets the voltage in force; the exact switch is kept."""
    heard = Heard(reset=2.0)
    for n in range(50):
        heard.state(0, n * 10_000_000, (3000.0 if n >= 10 else 0.0, 0.0))
    for n in range(60):
        heard.measured(0, n * _FRAME + 1_000_000, 0.0)
    (recording,) = heard.recordings()
    times, voltages = recording.drive()
    assert times[np.argmax(voltages[:, 0] > 0)] == pytest.approx(0.1)
    first = np.argmax(recording.voltage[:, 0] > 0)
    assert recording.time_s[first - 1] < 0.1 <= recording.time_s[first]


def test_a_body_at_zero_volt_is_passive():
    """A beam that only swings has no drive."""
    heard = Heard(reset=2.0)
    _run(heard, 0, 0, voltage=0.0)
    assert heard.recordings()[0].voltage is None


def test_a_run_after_a_fault_is_not_lost():
    """While the supply does not know its voltage the camera goes on: all runs before and after are given back."""
    heard = Heard(reset=2.0)
    for n in range(1200):
        stamp = _EPOCH_NS + n * _FRAME
        driven = 4000.0 if 120 <= n < 180 else 5000.0 if 900 <= n < 960 else 0.0
        known = not 300 <= n < 700
        heard.state(0, stamp, (driven, 0.0) if known else (np.nan, np.nan))
        heard.measured(0, stamp, 0.01)
    runs = heard.recordings(ended=True)
    assert [run.voltage.max() for run in runs] == [4000.0, 5000.0]
    assert all(0.25 < np.argmax(run.voltage[:, 0]) * _FRAME * 1e-9 + 0.01 < 0.27 for run in runs)
    assert len({run.name for run in runs}) == 2


def test_a_drive_that_is_no_longer_known_is_not_held():
    """The run ends where the supply lost sight of its voltage, though the camera goes on."""
    heard = Heard(reset=2.0)
    for n in range(600):
        stamp = _EPOCH_NS + n * _FRAME
        heard.state(0, stamp, (5000.0, 0.0) if n < 60 else (np.nan, np.nan))
        heard.measured(0, stamp, 0.01)
    (run,) = heard.recordings(ended=True)
    assert run.time_s[-1] == pytest.approx(60 * _FRAME * 1e-9)


def test_a_run_that_is_going_on_can_be_waited_for():
    """It is given back once a second has passed after its drive; before that, with the others only."""
    heard = Heard(reset=2.0)
    for n in range(150):
        if n == 100:
            with pytest.raises(SysidError, match="no run that was heard has ended"):
                heard.recordings(ended=True)
            assert len(heard.recordings()) == 1
        heard.state(0, n * _FRAME, (5000.0 if n < 20 else 0.0, 0.0))
        heard.measured(0, n * _FRAME, 0.01 * n)
    assert heard.recordings(ended=True)[0].time_s[-1] == pytest.approx(20 * _FRAME * 1e-9 + 1.0, abs=0.01)


def test_nothing_heard_is_said():
    """Also when only one of the two topics spoke."""
    heard = Heard(reset=2.0)
    for n in range(50):
        heard.state(0, n * _FRAME, (0.0, 0.0))
    with pytest.raises(SysidError, match="no run was heard"):
        heard.recordings()


def _stream(*driven: tuple[float, float], end: float) -> tuple[np.ndarray, np.ndarray, float]:
    time = np.arange(0.0, end, 0.01)
    on = np.any([(begin - 1e-9 <= time) & (time < stop - 1e-9) for begin, stop in driven], axis=0)
    return time, np.stack([5000.0 * on, np.zeros(len(time))], axis=1), end


def test_two_experiments_with_a_pause_are_two_parts():
    """Each with some rest before and its ringing after."""
    parts = driven_parts(*_stream((10.0, 12.0), (60.0, 61.0), end=100.0))
    assert parts == [pytest.approx((9.75, 13.0)), pytest.approx((59.75, 62.0))]


def test_the_half_periods_of_one_experiment_stay_together():
    """Short rests belong to the waveform."""
    parts = driven_parts(*_stream((1.0, 1.5), (2.0, 2.5), (3.0, 3.5), end=20.0))
    assert parts == [pytest.approx((0.75, 4.5))]


def test_parts_stay_within_the_stream():
    """Driven from the first to the last message."""
    assert driven_parts(*_stream((0.0, 1.0), end=1.0)) == [pytest.approx((0.0, 1.0))]


def test_a_body_never_driven_is_one_part():
    """A beam that was let go."""
    time = np.arange(100) * 0.01
    assert driven_parts(time, np.zeros((100, 2)), 1.0) == [(0.0, 1.0)]


_S = 1_000_000_000
ON, OFF = (0.0, -4000.0), (0.0, 0.0)


@pytest.fixture
def watch():
    """Driven from 3 s to 5 s."""
    watch = DriveWatch()
    assert not watch.begins(0, 0, OFF)
    assert watch.begins(0, 3 * _S, ON)
    assert not watch.begins(0, 5 * _S, OFF)
    return watch


def test_a_run_is_over_a_second_after_its_drive(watch):
    """What rings after it still belongs to it; before the first run nothing is over."""
    assert [watch.is_over(0, round(t * _S)) for t in (1.0, 4.0, 5.5, 6.0, 6.1, 60.0)] == [False] * 4 + [
        True
    ] * 2


def test_a_frame_of_the_rest_may_come_after_the_next_start(watch):
    """Angles come later than states."""
    assert watch.begins(0, 9 * _S, ON)
    assert watch.is_over(0, 8 * _S)
    assert not watch.is_over(0, 9 * _S)


def test_a_short_rest_is_none(watch):
    """Of a drive with pauses."""
    assert not watch.begins(0, 7 * _S, ON)


def test_a_voltage_holds_until_the_next_state():
    """States that come only when something changes: a body that is held bent is driven all the time."""
    watch = DriveWatch()
    watch.begins(0, 0, ON)
    assert not watch.is_over(0, 30 * _S)
    assert not watch.begins(0, 31 * _S, ON)


def test_another_epoch_knows_nothing_of_the_last(watch):
    """Stamps that went back are of another run."""
    assert not watch.begins(1, 0, OFF)
    assert not watch.is_over(1, 60 * _S)
    assert watch.begins(1, 3 * _S, ON)


def test_an_unknown_voltage_begins_no_run():
    """A supply in FAULT says NaN."""
    assert not DriveWatch().begins(0, 0, (float("nan"), 0.0))
