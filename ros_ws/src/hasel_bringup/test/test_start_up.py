"""What a command uses until it has done its work."""

import subprocess
import sys

import pytest
from hasel_bringup import start_up


def test_counts_the_process_s_own_time_and_memory():
    """A second of processor time and 300 MB are seen; sleeping costs nothing."""
    idle = start_up.used_by([sys.executable, "-c", "import time; time.sleep(0.3)"])
    work = "import time\nwhile time.process_time() < 1.0: pass\nkept = b'x' * 300_000_000"
    busy = start_up.used_by([sys.executable, "-c", work])
    assert busy.seconds >= 1.0
    assert idle.seconds < 0.5
    assert busy.megabytes > 280


def test_a_command_that_fails_is_no_measurement():
    """Nobody takes an error at once for a quick start."""
    with pytest.raises(subprocess.CalledProcessError):
        start_up.used_by([sys.executable, "-c", "raise SystemExit(3)"])


@pytest.mark.parametrize(
    ("seconds", "megabytes", "met"), [(0.2, 100.0, True), (0.6, 100.0, False), (0.2, 400.0, False)]
)
def test_bars(seconds, megabytes, met, monkeypatch, capsys, tmp_path):
    """Each measured figure stands beside its bar, and the result says whether all are met."""
    (tmp_path / "a.csv").touch()
    monkeypatch.setattr(start_up, "COMPARED", tmp_path)
    monkeypatch.setattr(start_up, "least_used", lambda command: start_up.Used(seconds, megabytes))
    assert start_up.measure() is met
    said = capsys.readouterr().out
    assert ("MISSED" in said) is not met
    assert "compare of 1 runs" in said
