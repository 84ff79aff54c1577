"""What was heard becomes recordings."""

import numpy as np
import pytest
from hasel_sysid.errors import SysidError
from hasel_sysid.live.heard import Heard

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
