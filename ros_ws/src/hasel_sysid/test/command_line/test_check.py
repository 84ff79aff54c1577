# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`check`: what was understood of a recording, and what looks wrong."""

import json

import numpy as np
import pytest
from hasel_recording.recording import KNOWN_KEYS
from hasel_sysid.command_line import check, compare


def rows(time_factor: float = 1.0, degrees: float = 1.0, blank: int = 0) -> str:
    """Two seconds of a body that follows two muscles in turn with a lag; every `blank`th angle is missing."""
    noise, angle, lines = np.random.default_rng(0).normal(size=240), 0.0, []
    for n in range(240):
        upper = n % 60 < 30
        angle += 0.1 * ((0.1 if upper else -0.1) - angle)
        shown = "" if blank and n % blank == 7 else f"{degrees * (angle + 1e-3 * noise[n]):.6f}"
        lines.append(f"{time_factor * n / 120:.6f},{5 * upper},{5 * (not upper)},{shown}\n")
    return "".join(lines)


@pytest.fixture
def lab_file(tmp_path):
    """A lab's own file: milliseconds, kilovolts, degrees, an angle missing now and then."""
    path = tmp_path / "lab.csv"
    path.write_text("#model: swimmer\nt,U1,U2,angle_deg\n" + rows(1e3, np.degrees(1), 50))
    return path


MAP = "time_ms=t,voltage_upper_kv=U1,voltage_lower_kv=U2,sin_theta=angle_deg"


def test_says_what_was_understood(lab_file, tmp_path, capsys):
    """Frames, rate, angle, drive with its levels and frequency, markers, start, and how columns were read."""
    target = tmp_path / "check.json"
    code = check.main([str(lab_file), "--map", MAP, "--model", "swimmer", "--json", str(target)])
    said = capsys.readouterr().out
    assert code == 0, said
    for text in (
        "240 from 0 to 1.99167 s, 120 per second, 5 without an angle",
        "(θ from -",
        "voltage of upper [V]: 0 and 5000 V",
        "repeats at 2 Hz, 3.98 cycles from 0 s on",
        "none recorded, only the angle",
        "from rest at 0 s",
        "time is column 't', times 0.001 in s",
        "sin θ is the sine of column 'angle_deg'",
        "voltage of lower [V] is column 'U2', times 1000",
        "swimmer, driven by voltage of upper [V], voltage of lower [V]: fits",
    ):
        assert text in said
    (content,) = json.loads(target.read_text())["recordings"]
    assert content["good"]
    assert {row["what"] for row in content["understood"]} >= {
        "frames",
        "angle",
        "drive",
        "start",
        "read",
        "model",
    }


def test_what_check_refuses_compare_refuses_alike(lab_file, capsys):
    """Without the map the same sentence comes from both, before anything is simulated."""
    assert check.main([str(lab_file)]) == 2
    said = capsys.readouterr().err
    assert "no column 'time_s'" in said
    assert compare.main([str(lab_file)]) == 2
    assert capsys.readouterr().err == said


def test_a_recording_that_does_not_fit_the_model_does_not_look_in_order(tmp_path, capsys):
    """Without columns of the drive, for a body with muscles."""
    path = tmp_path / "run.csv"
    path.write_text("time_s,sin_theta\n" + "".join(f"{n / 120},{0.1 * np.sin(n / 9)}\n" for n in range(240)))
    assert check.main([str(path), "--model", "swimmer"]) == 2
    said = capsys.readouterr()
    assert "run has no drive, and model 'swimmer' is driven by upper [V], lower [V]" in said.err
    assert "model    does not fit: see the error" in said.out
    assert "looks in order" not in said.out
    assert check.main([str(path)]) == 0
    assert "looks in order" in capsys.readouterr().out


def test_milliseconds_under_another_name_are_noticed_before_simulating(tmp_path, capsys):
    """time_s that counts milliseconds is refused with the name it should have."""
    path = tmp_path / "ms.csv"
    path.write_text("time_s,voltage_upper_kv,voltage_lower_kv,sin_theta\n" + rows(1e3))
    for command in (check, compare):
        assert command.main([str(path)]) == 2
        out = capsys.readouterr()
        assert (
            "is the time in ms? then call its column time_ms, or give --map time_ms=COLUMN"
            in out.out + out.err
        )


def test_one_frame_is_one_sentence(tmp_path, capsys):
    """A file of one row ends in a sentence."""
    path = tmp_path / "one.csv"
    path.write_text("time_s,voltage_upper_v,voltage_lower_v,sin_theta\n0,0,0,0.1\n")
    for command in (check, compare):
        assert command.main([str(path)]) == 2
        out = capsys.readouterr()
        assert (
            "too few frames: 1 of 1 frames have an angle, expected 16 at least; record at least one period"
            in out.out + out.err
        )


def test_several_files_end_with_those_not_to_be_used(lab_file, tmp_path, capsys):
    """A file that cannot be read does not hide the others."""
    other = tmp_path / "none.csv"
    assert check.main([str(lab_file), str(other), "--map", MAP]) == 2
    said = capsys.readouterr()
    assert "Not to be used as they are: none." in said.out
    assert "There is no file" in said.err


def test_a_misspelt_header_key_is_said(lab_file, capsys):
    """A key that is nearly a known one is most likely meant; any other is kept as a note."""
    lab_file.write_text("#inital_state: rest\n#operator: Ann\n" + lab_file.read_text())
    check.main([str(lab_file), "--map", MAP])
    said = capsys.readouterr().out
    assert "did you mean 'initial_state'?" in said
    assert "operator: Ann" in said
    assert "initial_state" in KNOWN_KEYS
