# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The same run given more than once."""

import shutil
import warnings

import hasel_sysid as h
import pytest
from hasel_recording import RecordingWarning, read_recording
from hasel_recording.command_line import convert
from hasel_sysid.command_line import check, compare
from hasel_sysid.dataset import load_experiments
from hasel_sysid.errors import SysidError


@pytest.fixture
def run(unseen_rig):
    """A recording."""
    return unseen_rig / "quadratic_drag" / "fit_5500V_2.0Hz.csv"


@pytest.fixture
def copy(run, tmp_path):
    """The same frames under another name, in another format."""
    return convert(shutil.copy(run, tmp_path / "other.csv"))


@pytest.mark.parametrize("step", [h.simulate, h.fit, h.improve])
def test_a_run_is_not_fitted_and_unseen_at_once(step, run, copy):
    """Its error would be called one of unseen runs."""
    with pytest.raises(
        SysidError, match=r"other, given as unseen, is the same run as fit_5500V_2\.0Hz, which is"
    ):
        step("swimmer", run, unseen=copy)


def test_the_commands_refuse_it_too(run, copy, tmp_path, capsys):
    """Under its own name and under another one."""
    for unseen in (run, copy):
        assert compare.main([str(run), "--validate", str(unseen), "--output", str(tmp_path / "out")]) == 2
        assert "an unseen run is never fitted: leave out one of the two" in capsys.readouterr().err


def test_twice_the_same_run_counts_once(run, copy):
    """Read from files, or put together from what was read."""
    with pytest.warns(RecordingWarning, match=r"other is the same run as fit_5500V_2\.0Hz .* counts once"):
        (experiment,) = load_experiments([run, copy])
    with pytest.warns(RecordingWarning, match="twice the same noise is not two runs"):
        assert len(h.simulate("swimmer", [experiment, read_recording(copy)]).comparison.runs) == 1


def test_check_says_so(run, capsys):
    """In a warning of its own."""
    check.main([str(run), str(run)])
    assert "warning: fit_5500V_2.0Hz_2 is the same run as fit_5500V_2.0Hz" in capsys.readouterr().err


def test_other_runs_are_other_runs(run):
    """Of the same drive and length, with noise of their own."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(load_experiments(sorted(run.parent.glob("*.csv")))) > 3
