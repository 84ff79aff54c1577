# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Recordings made with former definitions of the messages."""

from pathlib import Path

import numpy as np
import pytest
from hasel_common.topics import MEASURED, SIMULATED, STATE
from hasel_recording import read_recording
from hasel_recording.command_line import convert
from hasel_recording.drive_channel import HASEL_PAIR
from rosbags.highlevel import AnyReader

pytestmark = pytest.mark.filterwarnings("ignore::hasel_recording.RecordingWarning")  # of the first frame
BEFORE_PROOF_OF_GROUND = Path(__file__).parent / "recordings" / "before_proof_of_ground.mcap"
PAIRS_OF_VOLTAGES = Path(__file__).parent / "recordings" / "pairs_of_voltages.mcap"
"""RunExperiment on the virtual rig, 4500 V, 4 Hz, two periods, when a SupplyState had exactly two voltages, no names
of the muscles, and a BendingAngle a sin_theta_std."""


@pytest.fixture(scope="module")
def independent() -> dict[str, list[tuple[float, list[float]]]]:
    """By topic the time [s] and the values of every message, as another library reads them."""
    heard = {STATE: [], MEASURED: [], SIMULATED: []}
    with AnyReader([PAIRS_OF_VOLTAGES]) as reader:
        for connection, _, data in reader.messages():
            message = reader.deserialize(data, connection.msgtype)
            values = message.commanded_voltage.tolist() if connection.topic == STATE else [message.sin_theta]
            stamp = message.header.stamp
            heard[connection.topic].append((stamp.sec + stamp.nanosec * 1e-9, values))
    return heard


def test_old_recording_is_read_as_another_library_reads_it(independent):
    """Angles, voltages and what the simulator said are those of the messages, each voltage from its stamp on."""
    run = read_recording(PAIRS_OF_VOLTAGES)
    assert run.channels == HASEL_PAIR
    begin = independent[STATE][0][0]
    frames = [(time, values) for time, values in independent[MEASURED] if time >= begin]
    assert len(frames) > 60
    np.testing.assert_array_equal(run.sin_theta, [values[0] for _, values in frames])
    state_times = [time for time, _ in independent[STATE]]
    in_force = np.searchsorted(state_times, [time for time, _ in frames], side="right") - 1
    np.testing.assert_array_equal(run.voltage, [independent[STATE][index][1] for index in in_force])
    assert {tuple(pair) for pair in run.voltage.tolist()} >= {(4500.0, 0.0), (0.0, 4500.0)}
    assert run.simulated_sin_theta.tolist() == [values[0] for _, values in independent[SIMULATED]]


def test_old_recording_is_converted_to_the_definitions_of_today(tmp_path):
    """To CSV and to MCAP again: the second one has names of muscles, and every frame is as it was."""
    table = convert(PAIRS_OF_VOLTAGES, tmp_path / "run.csv")
    new = convert(table, tmp_path / "run.mcap")
    with AnyReader([new]) as reader:
        (connection,) = (each for each in reader.connections if each.topic == STATE)
        _, _, data = next(reader.messages([connection]))
        assert reader.deserialize(data, connection.msgtype).muscle == ["upper", "lower"]
    old, now = read_recording(PAIRS_OF_VOLTAGES), read_recording(new)
    np.testing.assert_allclose(now.time_s - now.time_s[0], old.time_s - old.time_s[0], atol=2e-9)
    np.testing.assert_array_equal(now.sin_theta, old.sin_theta)
    np.testing.assert_array_equal(now.voltage, old.voltage)


def test_a_state_from_before_the_proof_of_ground_is_read_alike():
    """A SupplyState that has neither `ground` nor `commander` gives the same run as the recording it was made of."""
    run, before = read_recording(BEFORE_PROOF_OF_GROUND), read_recording(PAIRS_OF_VOLTAGES)
    np.testing.assert_array_equal(run.sin_theta, before.sin_theta)
    for mine, other in zip(run.drive(), before.drive(), strict=True):
        np.testing.assert_allclose(mine, other, atol=1e-9)
