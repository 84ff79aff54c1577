# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Every injected fault is named as what it is, and clean recordings are left in peace."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_recording import DriveChannel, Recording, read_recording
from hasel_sysid.data_quality import Severity, check_recording, refusal


def _markers(sin_theta: np.ndarray) -> np.ndarray:
    """Head, middle and tail [m] [n, 3, 2] of a body that bends at its middle."""
    angle = np.arcsin(sin_theta)
    head, middle = np.array([0.005, 0.0]), np.array([0.094, 0.0])
    tail = middle + 0.096 * np.column_stack([np.cos(angle), np.sin(angle)])
    return np.stack([np.tile(head, (len(angle), 1)), np.tile(middle, (len(angle), 1)), tail], axis=1)


def _with_markers(recording: Recording) -> Recording:
    return replace(recording, markers=_markers(recording.sin_theta))


def _changed(recording: Recording, rows, column_values) -> np.ndarray:
    series = recording.sin_theta.copy()
    series[rows] = column_values
    return series


def _without_rows(recording: Recording, rows) -> Recording:
    kept = np.setdiff1d(np.arange(len(recording.time_s)), rows)
    return replace(
        recording,
        time_s=recording.time_s[kept],
        sin_theta=recording.sin_theta[kept],
        drive_signal=recording.voltage[kept],
    )


def _swapped_rows(recording: Recording) -> Recording:
    time = recording.time_s.copy()
    time[[50, 51]] = time[[51, 50]]
    return replace(recording, time_s=time)


def _jittered(recording: Recording) -> Recording:
    shake = np.random.default_rng(3).uniform(-0.4, 0.4, len(recording.time_s)) / 120
    return replace(recording, time_s=recording.time_s + shake)


def _early_camera(recording: Recording) -> Recording:
    """The drive's clock runs 300 ms behind: rest, then motion, then the command."""
    rest = 12
    still = np.random.default_rng(4).normal(size=rest) * 0.002
    time = np.arange(len(recording.time_s) + rest) / 120
    late = round(0.3 * 120)
    voltage = np.vstack([np.zeros((rest + late, 2)), recording.voltage[:-late]])
    return replace(
        recording, time_s=time, sin_theta=np.concatenate([still, recording.sin_theta]), drive_signal=voltage
    )


def _late_camera(recording: Recording) -> Recording:
    late = round(0.4 * 120)
    still = np.random.default_rng(5).normal(size=late) * 0.002
    return replace(recording, sin_theta=np.concatenate([still, recording.sin_theta[:-late]]))


def _exchanged(recording: Recording, first: int, second: int, rows=slice(None)) -> Recording:
    markers = _markers(recording.sin_theta)
    order = [0, 1, 2]
    order[first], order[second] = order[second], order[first]
    markers[rows] = markers[rows][:, order]
    return replace(recording, markers=markers)


FAULTS = {
    "time order": (_swapped_rows, "time order", "error"),
    "milliseconds": (lambda r: replace(r, time_s=r.time_s * 1e3), "unit of time", "error"),
    "dropped frames": (lambda r: _without_rows(r, [40, 41, 42, 90]), "dropped frames", "warning"),
    "jitter": (_jittered, "jitter", "warning"),
    "15 frames/s": (
        lambda r: _without_rows(r, np.flatnonzero(np.arange(len(r.time_s)) % 8)),
        "frame rate",
        "warning",
    ),
    "lost frames": (
        lambda r: replace(r, sin_theta=_changed(r, slice(60, 64), np.nan)),
        "lost frames",
        "warning",
    ),
    "degrees": (
        lambda r: replace(r, sin_theta=np.degrees(np.arcsin(r.sin_theta))),
        "unit of the angle",
        "error",
    ),
    "frozen": (
        lambda r: replace(r, sin_theta=_changed(r, slice(80, 140), r.sin_theta[80])),
        "frozen angle",
        "error",
    ),
    "jumps": (
        lambda r: replace(r, sin_theta=_changed(r, [70, 71, 150], 0.9)),
        "jumping marker",
        "warning",
    ),
    "no motion": (
        lambda r: replace(r, sin_theta=0.002 * np.random.default_rng(6).normal(size=len(r.time_s))),
        "too little excitation",
        "error",
    ),
    "one step": (
        lambda r: replace(r, drive_signal=np.tile([4500.0, 0.0], (len(r.time_s), 1))),
        "too little excitation",
        "warning",
    ),
    "kilovolts": (lambda r: replace(r, drive_signal=r.voltage / 1e3), "unit of the voltage", "error"),
    "no command": (lambda r: replace(r, drive_signal=0 * r.voltage), "no command", "warning"),
    "unused channel": (lambda r: replace(r, drive_signal=r.voltage * (1, 0)), "dead channel", "warning"),
    "dead by the header": (
        lambda r: replace(r, drive_signal=r.voltage * (0, 1), metadata={"muscles": "both"}),
        "dead channel",
        "error",
    ),
    "no answer to the lower side": (
        lambda r: replace(r, sin_theta=np.where(r.sin_theta > 0, r.sin_theta, 0.05 * r.sin_theta)),
        "dead channel",
        "error",
    ),
    "same voltage twice": (
        lambda r: replace(r, drive_signal=np.repeat(r.voltage[:, :1], 2, axis=1)),
        "doubled channel",
        "error",
    ),
    "clipped by the limit": (
        lambda r: replace(r, metadata={"voltage_v": "6000"}),
        "clipped command",
        "error",
    ),
    "one channel clipped": (
        lambda r: replace(r, drive_signal=r.voltage * (1, 0.9)),
        "clipped command",
        "warning",
    ),
    "clipped sine": (
        lambda r: replace(
            r,
            drive_signal=np.minimum(
                4000.0, 4500 * np.abs(np.sin(2 * np.pi * 2 * r.time_s + 1e-9))[:, None] * (r.voltage > 0)
            ),
        ),
        "clipped command",
        "warning",
    ),
    "one switch late": (
        lambda r: replace(
            r,
            drive_signal=r.voltage[
                np.where(np.abs(np.arange(len(r.time_s)) - 95) <= 5, 89, np.arange(len(r.time_s)))
            ],
        ),
        "shifted command",
        "warning",
    ),
    "other frequency than said": (
        lambda r: replace(r, metadata={"frequency_hz": "2.5"}),
        "shifted command",
        "warning",
    ),
    "faked command": (
        lambda r: replace(r, sin_theta=(r.voltage[:, 0] - r.voltage[:, 1]) * 1e-4),
        "command equals measurement",
        "error",
    ),
    "sign flip": (lambda r: replace(r, sin_theta=-r.sin_theta), "sign flip or swapped channels", "error"),
    "swapped channels": (
        lambda r: replace(r, drive_signal=r.voltage[:, ::-1]),
        "sign flip or swapped channels",
        "error",
    ),
    "camera ahead": (_early_camera, "motion before command", "error"),
    "camera behind": (_late_camera, "command lag", "warning"),
    "millimetres": (
        lambda r: replace(r, markers=1e3 * _markers(r.sin_theta)),
        "unit of the markers",
        "error",
    ),
    "middle and tail": (lambda r: _exchanged(r, 1, 2), "marker swap", "error"),
    "head and middle": (lambda r: _exchanged(r, 0, 1), "marker swap", "error"),
    "exchanged for a while": (lambda r: _exchanged(r, 0, 2, slice(100, 120)), "marker swap", "error"),
    "head and tail": (lambda r: _exchanged(r, 0, 2), "sign flip", "error"),
    "degrees beside markers": (
        lambda r: replace(_with_markers(r), sin_theta=np.degrees(r.sin_theta) / 57.3 * 50),
        "unit of the angle",
        "error",
    ),
    "another angle than the markers'": (
        lambda r: replace(_with_markers(r), sin_theta=0.9 * r.sin_theta),
        "angle does not fit the markers",
        "warning",
    ),
}


@pytest.mark.parametrize("name", FAULTS)
def test_fault_is_named(made_recording, name):
    """The injected fault is found, with its severity, and the first thing said."""
    inject, fault, severity = FAULTS[name]
    found = check_recording(inject(made_recording()))
    assert fault in [finding.fault for finding in found]
    finding = next(f for f in found if f.fault == fault)
    assert finding.severity is Severity(severity)
    assert found[0].severity is Severity(severity)
    assert str(finding).startswith(f"run: {fault}: ")
    assert str(finding)[-1] in ".?"


def test_middle_and_tail_are_told_from_head_and_middle(made_recording):
    """The advice names the two markers that are exchanged."""
    tail = check_recording(_exchanged(made_recording(), 1, 2))[0]
    head = check_recording(_exchanged(made_recording(), 0, 1))[0]
    assert "middle and tail" in str(tail)
    assert "middle and head" in str(head)


@pytest.mark.parametrize("frequency", [0.5, 2.0, 2.5, 3.5])
@pytest.mark.parametrize("seed", range(5))
def test_clean_recording_has_no_finding(made_recording, frequency, seed):
    """Nothing is said about a clean run, with or without markers."""
    recording = made_recording(frequency=frequency, seed=seed)
    assert check_recording(recording) == []
    assert check_recording(_with_markers(recording)) == []


def test_image_markers_have_y_downwards(made_recording):
    """Pixels with y downwards give the same angle, so nothing is said."""
    recording = made_recording()
    pixels = 8000 * _markers(recording.sin_theta) * (1, -1) + 300
    assert check_recording(replace(recording, markers=pixels, marker_unit="px")) == []


def test_passive_body_needs_no_command(made_recording):
    """A body that is let go has no voltage and is not blamed for it."""
    time = np.arange(0, 2, 0.01)
    swing = 0.1 * np.exp(-time) * np.cos(30 * time) + 1e-4 * np.random.default_rng(0).normal(size=len(time))
    assert check_recording(Recording("beam", time, swing)) == []


def _pressures(recording: Recording) -> Recording:
    """The upper channel as the pressure of a chamber."""
    chamber = DriveChannel("chamber", "pressure", "Pa")
    return replace(recording, drive_signal=recording.voltage[:, :1] * 5, channels=(chamber,))


def test_a_pressure_run_is_in_order(made_recording):
    """One chamber that is filled and emptied is as good as two muscles."""
    assert check_recording(_pressures(made_recording())) == []


def test_a_pressure_in_bar_is_noticed(made_recording):
    """Whatever the quantity, a size that only another unit explains is said with that unit."""
    run = _pressures(made_recording())
    (finding,) = check_recording(replace(run, drive_signal=run.drive_signal / 1e5))
    assert "the largest pressure is 0.225 Pa; is it in bar, mbar or kPa?" in str(finding)


def test_three_channels_are_in_order(made_recording):
    """A finger's three muscles in turn: no channel is dead, doubled or late; an unused one is named."""
    channels = tuple(DriveChannel(name, "voltage", "V") for name in ("root", "middle", "tip"))
    run = made_recording()
    turn = np.floor(run.time_s * 6).astype(int) % 3
    signal = 5000.0 * (turn[:, None] == np.arange(3))
    assert check_recording(replace(run, drive_signal=signal, channels=channels)) == []
    found = check_recording(replace(run, drive_signal=signal * (1, 1, 0), channels=channels))
    assert [finding.evidence for finding in found] == ["channel tip never gets a voltage"]


def test_overlapping_drive_is_no_shifted_command(made_recording):
    """Muscles that are driven together for a quarter of the cycle switch as regularly as any."""
    recording = made_recording()
    phase = np.mod(recording.time_s * 2.0 + 1e-9, 1.0)
    both = 4500.0 * np.column_stack([phase < 0.6, (phase >= 0.45) | (phase < 0.1)])
    assert check_recording(replace(recording, drive_signal=both)) == []


def test_a_fast_swing_is_in_order():
    """At 30 Hz and 120 frames/s every frame is far from its neighbours, and switches lie up to a frame off."""
    time = np.arange(0, 3, 1 / 120)
    upper = np.mod(30 * time, 1) < 0.5
    noise = 0.002 * np.random.default_rng(0).normal(size=len(time))
    swing = 0.2 * np.sin(2 * np.pi * 30 * time + 0.3) + noise
    drive = 5000.0 * np.column_stack([upper, ~upper])
    assert check_recording(Recording("fast", time, swing, drive)) == []


def test_a_swing_before_a_slow_camera_is_no_jump():
    """At 30 frames/s a swing at 2 Hz has peaks far from their neighbours; what goes further is a jump."""
    time = np.arange(0, 2, 1 / 30)
    phase = np.mod(2 * time + 1e-9, 1.0)
    noise = 0.002 * np.random.default_rng(0).normal(size=len(time))
    swing = 0.8 * np.sin(2 * np.pi * phase) + noise
    drive = 5000.0 * np.column_stack([phase < 0.5, phase >= 0.5])
    assert "jumping marker" not in {
        found.fault for found in check_recording(Recording("slow", time, swing, drive))
    }
    swing[18] -= 0.8
    (jump,) = (
        f for f in check_recording(Recording("slow", time, swing, drive)) if f.fault == "jumping marker"
    )
    assert "in 1 frames" in jump.evidence


def test_jitter_is_not_taken_for_missing_frames(made_recording):
    """A late stamp makes one long and one short step: no frame is missing."""
    faults = {finding.fault for finding in check_recording(_jittered(made_recording()))}
    assert "jitter" in faults
    assert "dropped frames" not in faults


@pytest.mark.parametrize(("factor", "unit"), [(1e3, "ms"), (1e6, "us"), (1e9, "ns")])
def test_time_in_another_unit_is_refused_by_name(made_recording, factor, unit):
    """Steps that can only be a smaller unit are said with it, and nothing else is."""
    recording = made_recording()
    finding = refusal(replace(recording, time_s=recording.time_s * factor))
    assert f"is the time in {unit}? then call its column time_{unit}" in str(finding)
    assert refusal(recording) is None


def test_a_run_of_hours_is_refused(made_recording):
    """Every frame is simulated: a run of hours is said before it is."""
    time = np.arange(0, 3 * 3600, 1 / 30)
    finding = refusal(Recording("night", time, 0.1 * np.sin(time)))
    assert "the run lasts 3 h with 324000 frames" in str(finding)


def test_too_short_recording_is_said_to_be(made_recording):
    """A run of ten frames is refused before anything else."""
    recording = _without_rows(made_recording(), np.arange(10, 240))
    assert [finding.fault for finding in check_recording(recording)] == ["too few frames"]


def test_no_false_alarm_on_the_unseen_rig(unseen_rig):
    """None of the clean runs of the independent simulator, with or without a hidden effect, is blamed."""
    paths = sorted(unseen_rig.glob("*/*.csv"))
    assert paths
    said = [str(finding) for path in paths for finding in check_recording(read_recording(path))]
    assert said == []


def test_measured_beam_is_clean(real_beam):
    """The measured swings of the silicone beam pass."""
    paths = sorted(real_beam.glob("*.csv"))
    assert paths
    assert [str(f) for path in paths for f in check_recording(read_recording(path))] == []


@pytest.mark.parametrize(
    ("header", "said"),
    [
        ({"initial_time_s": "soon"}, "initial_time_s is 'soon', expected a number"),
        ({"initial_time_s": "50"}, "let go at 50 s and the last frame is at"),
        ({"initial_stat": "rest"}, "did you mean 'initial_state'?"),
    ],
)
def test_header_lines_that_are_not_understood(made_recording, header, said):
    """A value that is no number, a start after the end, and a misspelt key are each said."""
    found = check_recording(made_recording(metadata=header))
    assert len(found) == 1
    assert said in str(found[0])


def test_a_finger_that_follows_its_pressure_is_no_command():
    """A soft finger driven slowly follows a measured pressure to 0.05 %: that is how it works, not a faked angle."""
    time = np.arange(0, 12, 1 / 60)
    rng = np.random.default_rng(11)
    pressure = 12000 * (1 - np.cos(2 * np.pi * 0.25 * time)) + 40 * rng.normal(size=len(time))
    angle = 1e-5 * pressure + 2e-4 * rng.normal(size=len(time))
    assert np.corrcoef(angle, pressure)[0, 1] > 0.999
    run = Recording(
        "finger", time, angle, pressure[:, None], channels=(DriveChannel("chamber", "pressure", "Pa"),)
    )
    assert not [f for f in check_recording(run) if f.severity is Severity.ERROR]


def test_switches_between_slow_frames_are_said():
    """At 30 frames/s a 2 Hz drive switches between frames: how far the body moves meanwhile is told; not at 120."""
    for rate, told in ((30, True), (120, False)):
        time = np.arange(0, 3, 1 / rate)
        upper = np.mod(2 * time + 1e-9, 1) < 0.5
        noise = 0.002 * np.random.default_rng(0).normal(size=len(time))
        run = Recording(
            "run",
            time,
            0.25 * np.sin(2 * np.pi * 2 * time) + noise,
            5000.0 * np.column_stack([upper, ~upper]),
        )
        found = [f for f in check_recording(run) if f.fault == "switches between frames"]
        assert bool(found) is told
        assert not found or "33.3 ms" in found[0].evidence
