# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
from hasel_recording import Recording, RecordingWarning, read_recording, write_recording
from hasel_tracker.errors import TrackerError
from hasel_tracker.offline.drive import (
    Drive,
    after_the_drive,
    align_by_hand,
    align_by_lamp,
    align_by_response,
    align_by_stamp,
    read_drive,
)
from hasel_tracker.offline.run_output import write_run
from hasel_tracker.offline.tracked_run import TrackedRun

TIMES = np.arange(240) / 120.0
START_NS = 1_700_000_000_000_000_000


def run_of(start_s: float, stamp_ns: int | None = None) -> TrackedRun:
    """A body that moves from `start_s` on, one marker lost in frame 100."""
    sin_theta = 0.3 * np.sin(2.0 * np.pi * 2.0 * np.maximum(TIMES - start_s, 0.0))
    sin_theta[100] = np.nan
    markers = np.random.default_rng(1).uniform(0.0, 900.0, (240, 3, 2))
    markers[100, 1] = np.nan
    return TrackedRun(TIMES, sin_theta, np.arcsin(sin_theta), markers, np.full((240, 3), 0.9), stamp_ns)


def box_drive(path, first_s: float) -> None:
    """The drive of a run as a CSV recording: upper then lower muscle at 5 kV."""
    times = np.array([0.0, first_s, first_s + 0.25, first_s + 0.5, 4.0])
    voltage = np.array([[0.0, 0.0], [5000.0, 0.0], [0.0, 5000.0], [5000.0, 0.0], [0.0, 0.0]])
    write_recording(Recording("drive", times, np.zeros(5), voltage), path)


@pytest.mark.parametrize("suffix", ["csv", "mcap"])
def test_voltages_are_read_from_either_kind(tmp_path, suffix):
    """CSV and MCAP recordings of the drive give the same voltages at the same times."""
    box_drive(tmp_path / f"drive.{suffix}", 1.0)
    drive = read_drive(tmp_path / f"drive.{suffix}")
    assert drive.end_s == pytest.approx(4.625)
    assert np.isnan(drive.at(np.array([4.7]))).all()  # the last voltage is not held for ever
    assert drive.at(np.array([-1.0, 0.99, 1.1, 1.3])).tolist() == [[0, 0], [0, 0], [5000, 0], [0, 5000]]


def test_a_lag_by_hand_or_by_a_lamp():
    """A lag that is given is taken; a lamp that lights with the drive gives it to half a frame; both are checked."""
    drive = Drive(np.array([0.0, 0.5, 1.0]), np.array([[0.0, 0.0], [5000.0, 0.0], [0.0, 5000.0]]))
    run = run_of(1.0)
    assert align_by_hand(0.25, run, drive).lag_s == 0.25
    with pytest.raises(TrackerError, match="do not overlap"):
        align_by_hand(-9.0, run, drive)
    lamp = np.where(TIMES >= 0.8, 200.0, 20.0)
    assert align_by_lamp(run, drive, lamp).lag_s == pytest.approx(0.3, abs=0.51 / 120)
    with pytest.raises(TrackerError, match="point --led at it"):
        align_by_lamp(run, drive, np.full(240, 20.0))


@pytest.mark.parametrize("suffix", ["csv", "mcap"])
def test_after_the_drive_nothing_is_held(tmp_path, suffix):
    """Where the drive's recording ends before the video, 3005 V are not held: the frames stay, their drive is NaN, a
    sentence says so, and what reads the recording leaves them out aloud."""
    drive = Drive(np.arange(100) / 100.0, np.full((100, 2), 3005.0))
    run, path = run_of(0.5), tmp_path / f"run.{suffix}"
    alignment = align_by_hand(0.0, run, drive)
    said = after_the_drive(run, drive, alignment)
    assert "ends 0.992 s before the video" in said
    assert "last 119 frames" in said
    assert said in write_run(path, run, drive, alignment, {})
    with pytest.warns(RecordingWarning, match="119 frames after the drive's end were left out"):
        recording = read_recording(path)
    assert recording.time_s[-1] == pytest.approx(1.0)
    assert (recording.voltage == 3005.0).all()
    if suffix == "csv":
        rows = [line.split(",") for line in path.read_text().splitlines() if not line.startswith("#")]
        assert len(rows) == 241
        assert rows[-1][1:3] == ["", ""]
        assert float(rows[-1][-1]) == run.sin_theta[-1]
    short = run.between(0.0, 0.9)
    assert after_the_drive(short, drive, alignment) == ""


@pytest.mark.parametrize("suffix", ["csv", "mcap"])
def test_a_pressure_is_merged_as_well(tmp_path, suffix):
    """Whatever drives the body is kept with its channel's name and SI unit; its lag is given by hand."""
    (tmp_path / "pump.csv").write_text("time_ms,pressure_chamber_kpa\n0,0\n1000,25\n2500,0\n")
    drive, run, path = read_drive(tmp_path / "pump.csv"), run_of(1.0), tmp_path / f"run.{suffix}"
    with pytest.raises(TrackerError, match="the drive has pressure_chamber_pa; give --lag"):
        align_by_response(run, drive)
    write_run(path, run, drive, align_by_hand(-0.5, run, drive), {})
    recording = read_recording(path)
    assert [channel.column for channel in recording.channels] == ["pressure_chamber_pa"]
    assert recording.drive_signal[[30, 90], 0].tolist() == [0.0, 25e3]


def test_stamps_decide_where_both_have_them():
    """With stamps the lag is their difference, to the nanosecond, whatever moves."""
    drive = Drive(np.array([0.0, 0.5]), np.zeros((2, 2)), START_NS + 250_000_000)
    assert align_by_stamp(run_of(1.0, START_NS), drive).lag_s == pytest.approx(0.25)
    with pytest.raises(TrackerError, match="does not overlap"):
        align_by_stamp(run_of(1.0, START_NS + 10**12), drive)
    with pytest.raises(TrackerError, match="The video has no stamps"):
        align_by_stamp(run_of(1.0), drive)


@pytest.mark.parametrize("suffix", ["csv", "mcap"])
@pytest.mark.parametrize("stamp_ns", [None, START_NS])
def test_merged_run_reads_back(tmp_path, suffix, stamp_ns):
    """The written recording holds angle, markers and the voltages of their moment; lost frames stay without angle."""
    box_drive(tmp_path / "drive.csv", 1.0)
    run, drive = run_of(0.4, stamp_ns), read_drive(tmp_path / "drive.csv")
    alignment = align_by_hand(-0.6, run, drive)
    path = tmp_path / f"run.{suffix}"
    left_out = write_run(path, run, drive, alignment, {"model": "swimmer"})
    recording = read_recording(path)
    assert recording.time_s == pytest.approx(TIMES, abs=1e-9)
    assert np.array_equal(recording.sin_theta, run.sin_theta, equal_nan=True)
    assert np.array_equal(recording.markers, run.markers_px, equal_nan=True)
    switched = np.argmax(recording.voltage[:, 0] > 0.0)
    assert recording.time_s[switched] == pytest.approx(0.4, abs=2.01 / 120.0)
    assert recording.metadata["model"] == "swimmer"
    assert recording.metadata["drive_merged"] == alignment.means
    assert left_out == ""


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("time_s\n0\n", "has no drive, only time_s"),
        (
            "time_s,voltage_upper_v,voltage_lower_v\n0,abc,0\n",
            "line 2: 'abc' in column voltage_upper_v is not a number",
        ),
        ("time_s,voltage_upper_v,voltage_lower_v\n1,0,0\n0,0,0\n", "does not come after 1"),
        ("time_s,voltage_upper_v,voltage_lower_v\n", "no frames"),
    ],
)
def test_unusable_drives_are_explained(tmp_path, text, message):
    """What is wrong with a drive's recording is said in one sentence."""
    path = tmp_path / "drive.csv"
    path.write_text(text)
    with pytest.raises(TrackerError, match=message):
        read_drive(path)
