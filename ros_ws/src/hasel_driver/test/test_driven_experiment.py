# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Experiments and the completeness of their recordings, without ROS or hardware."""

import math
import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hasel_driver.nodes.experiment_recording import ExperimentRecording
from hasel_driver.protocol.faults import LimitError, RefusedError
from hasel_driver.protocol.status import Mode
from hasel_driver.protocol.waveform import FileWaveform, Waveform
from hasel_driver.safety.driven_experiment import DrivenExperiment, ExperimentPlan
from hasel_recording.errors import RecordingError

STATE, MEASURED = "/hasel/state", "/hasel/bending/measured"
PLAN = ExperimentPlan(Waveform("box", 3000.0, 2.0, 3, polarity="alternating"), rest_s=0.5)


class FakeSupervisor:
    """Armed; without waveforms on the board, so that the experiment streams them."""

    def __init__(self) -> None:
        self.capabilities = SimpleNamespace(waveforms=False, bipolar=True)
        self.maximum_voltage_v = 5000.0
        self.mode, self.voltage_v, self.running = Mode.ARMED, (0.0, 0.0), False

    def status(self):
        return SimpleNamespace(mode=self.mode, commanded_v=self.voltage_v)

    def begin_experiment(self) -> None:
        if self.mode is not Mode.ARMED:
            raise RefusedError("not armed")
        self.running = True

    def hold(self, voltage_v) -> None:
        self.voltage_v = voltage_v

    def end_experiment(self) -> None:
        self.running, self.voltage_v = False, (0.0, 0.0)


def run(experiment, clock, supervisor, until_s: float = math.inf) -> list[tuple[float, float]]:
    """Step every millisecond; the voltages."""
    experiment.begin()
    voltages = []
    while not experiment.finished and clock[0] < until_s:
        clock[0] += 0.001
        experiment.step()
        voltages.append(supervisor.voltage_v)
    return voltages


def test_rests_drives_and_rests():
    """0 V for the rest, then the waveform for periods / frequency, then 0 V for the rest."""
    clock, supervisor = [0.0], FakeSupervisor()
    experiment = DrivenExperiment(PLAN, supervisor, lambda: clock[0])
    voltages = run(experiment, clock, supervisor)
    live = [index for index, voltage in enumerate(voltages) if any(voltage)]
    assert experiment.failure is None
    assert live[0] == pytest.approx(500, abs=3)
    assert live[-1] == pytest.approx(2000, abs=3)
    assert len(voltages) == pytest.approx(2500, abs=5)
    assert {voltage for voltage in voltages if any(voltage)} == {
        (3000.0, 0.0),
        (0.0, 3000.0),
        (-3000.0, 0.0),
        (0.0, -3000.0),
    }


@pytest.fixture
def drive(tmp_path) -> FileWaveform:
    """A file: one flat second, then rows of 50 ms that each ask for another voltage."""
    time_s = np.concatenate([np.arange(0.0, 1.0, 0.05), np.arange(1.0, 2.01, 0.05)])
    upper_v = np.where(time_s < 0.99, 1000.0, 1000.0 + 1000.0 * time_s.round(2))
    return FileWaveform(tmp_path / "drive.csv", time_s, np.stack([upper_v, 0.0 * upper_v], axis=1))


@pytest.mark.parametrize(
    ("late_at_s", "told"), [(None, None), (0.5, None), (1.33, "not sent: 2, the first that of 1.35 s")]
)
def test_rows_of_a_file_that_were_not_sent_are_told(drive, late_at_s, told):
    """Where the machine was late by 0.13 s: rows that ask for what is on already are not lost."""
    clock, supervisor = [0.0], FakeSupervisor()
    experiment = DrivenExperiment(ExperimentPlan(drive, 0.0), supervisor, lambda: clock[0])
    experiment.begin()
    while not experiment.finished:
        late = late_at_s is not None and abs(clock[0] - late_at_s) < 5e-4
        clock[0] += 0.13 if late else 0.001
        experiment.step()
    assert (experiment.failure is None) == (told is None)
    assert told is None or re.search(told, experiment.failure)


def test_the_first_row_is_sent_at_once():
    """Not with the next step, by when a short one may have ended."""
    clock, supervisor = [0.0], FakeSupervisor()
    experiment = DrivenExperiment(ExperimentPlan(PLAN.waveform), supervisor, lambda: clock[0])
    experiment.begin()
    experiment.step()
    assert supervisor.voltage_v == (3000.0, 0.0)


@pytest.mark.parametrize(
    ("lost_s", "told"), [(None, []), (1.5, ["the row of 1.5 s, 2500 and 0 V, was not seen"])]
)
def test_each_row_of_a_file_must_be_seen(tmp_path, drive, lost_s, told):
    """Also where others are too short to be, and between the extremes."""
    pytest.importorskip("hasel_interfaces", reason="the workspace is not built")
    from hasel_interfaces.msg import SupplyState

    short = replace(
        drive, time_s=np.append(drive.time_s, 2.01), voltages_v=np.append(drive.voltages_v, [[0, 0]], 0)
    )
    recording = ExperimentRecording(tmp_path / "run.mcap", ExperimentPlan(short))
    for time_s in np.arange(0.005, 2.01, 0.01):
        message = SupplyState(muscle=["upper", "lower"])
        message.header.stamp.sec, message.header.stamp.nanosec = int(time_s), round(time_s % 1 * 1e9)
        shown_s = time_s - 0.05 if lost_s is not None and lost_s < time_s < lost_s + 0.05 else time_s
        message.commanded_voltage = list(short.voltage(shown_s))
        recording.write(STATE, message)
    recording.close()
    assert recording.missing(short.duration_s) == told


def test_ends_when_the_supply_leaves_the_armed_state():
    """A fault ends the run, and is told."""
    clock, supervisor = [0.0], FakeSupervisor()
    experiment = DrivenExperiment(PLAN, supervisor, lambda: clock[0])
    run(experiment, clock, supervisor, until_s=1.0)
    supervisor.mode = Mode.FAULT
    experiment.step()
    assert "left the armed state" in experiment.failure
    assert not supervisor.running


def test_refuses_what_would_be_clipped():
    """A run above the limit would not be the one asked for."""
    supervisor = FakeSupervisor()
    supervisor.maximum_voltage_v = 2000.0
    with pytest.raises(LimitError, match="asks for 3000 V, the limit is 2000 V"):
        DrivenExperiment(PLAN, supervisor, lambda: 0.0).begin()
    with pytest.raises(LimitError, match="positive voltages only"):
        PLAN.check_against(5000.0, bipolar=False)


@pytest.fixture
def record(tmp_path):
    """Records a run with faults; returns what the recording is found to lack."""
    pytest.importorskip("hasel_interfaces", reason="the workspace is not built")
    from hasel_interfaces.msg import BendingAngle, SupplyState

    def write(
        keep=lambda time_s: True, scale=lambda time_s: 1.0, topics=(), measured=lambda time_s: True
    ) -> list[str]:
        recording = ExperimentRecording(tmp_path / "run.mcap", PLAN, topics)
        for index in range(round(PLAN.duration_s * 100)):
            time_s = index * 0.01
            message = SupplyState()
            message.header.stamp.sec = 1000 + int(time_s)
            message.header.stamp.nanosec = round(time_s % 1 * 1e9)
            voltage = PLAN.waveform.voltage(time_s + 0.005 - PLAN.rest_s)
            message.muscle = ["upper", "lower"]
            message.commanded_voltage = [scale(time_s) * value for value in voltage]
            if keep(time_s):
                recording.write(STATE, message)
            if topics and measured(time_s):
                recording.write(MEASURED, BendingAngle(header=message.header))
        recording.close()
        return recording.missing(PLAN.duration_s)

    return write


def test_a_full_disk_is_kept_as_the_problem(tmp_path):
    """Writing goes on without an error for whoever writes; closing tells it."""
    pytest.importorskip("hasel_interfaces", reason="the workspace is not built")
    from hasel_interfaces.msg import SupplyState

    path = tmp_path / "run.mcap"
    path.symlink_to("/dev/full")
    recording, message = ExperimentRecording(path, PLAN), SupplyState(commanded_voltage=[0.0, 0.0])
    while recording.problem is None:
        message.header.stamp.sec += 1
        recording.write(STATE, message)
    recording.write(STATE, message)
    assert re.search("space|written", recording.problem)
    with pytest.raises(RecordingError, match="could not be finished"):
        recording.close()


def test_what_comes_after_the_end_is_dropped(tmp_path):
    """The last state may cross the end of the run."""
    pytest.importorskip("hasel_interfaces", reason="the workspace is not built")
    from hasel_interfaces.msg import SupplyState

    recording = ExperimentRecording(tmp_path / "run.mcap", PLAN)
    recording.close()
    recording.write(STATE, SupplyState())
    assert recording.missing(PLAN.duration_s) == [f"no message of {STATE}"]


def test_a_complete_recording_lacks_nothing(record):
    """All states, and the topics that were there."""
    assert record(topics=(MEASURED,)) == []


@pytest.mark.parametrize(
    ("faults", "words"),
    [
        ({"keep": lambda t: False}, "no message of /hasel/state"),
        ({"keep": lambda t: t < 1.5}, "/hasel/state covers 1.49 s of 2.50 s"),
        ({"keep": lambda t: not 1.0 < t < 1.3}, "/hasel/state has a gap of 0.3"),
        ({"scale": lambda t: 0.5}, "the upper muscle reached 1500 V of 3000 V"),
        ({"scale": lambda t: 0.0}, "the lower muscle reached 0 V of 3000 V"),
        ({"scale": lambda t: float(not 0.95 < t < 1.45)}, "the upper muscle was driven 2 times of 3"),
        ({"topics": (MEASURED,), "measured": lambda t: False}, f"no message of {MEASURED}"),
        ({"topics": (MEASURED,), "measured": lambda t: not 0.5 < t < 1.9}, f"{MEASURED} has a gap of 1.4"),
    ],
)
def test_names_what_is_lacking(record, faults, words):
    """Each kind of gap is found in the file itself, and said."""
    assert any(words in text for text in record(**faults))
