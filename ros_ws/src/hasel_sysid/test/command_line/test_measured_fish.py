# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Films of a fish: read, their beat and speed found, their drive checked, their speeds compared.

Made-up films stand for the public ones; with FISHSIM=DIR, a clone of srl-ethz/fishsim, these are treated too.
"""

import json
import os
from pathlib import Path

import numpy as np
import pytest
from hasel_recording import read_recording
from hasel_sim.swimming.given_shape import POWERS, Beat, Fish, settled_speed, swimmer
from hasel_sysid.command_line.measured_fish import main
from hasel_sysid.data_quality import check_recording
from hasel_sysid.errors import SysidError
from hasel_sysid.filmed_fish import filmed_runs, fish_of, seen_beat

MADE = Fish(-0.071, 0.27, np.array([2.0 + 2.0j, -1.0 - 3.5j, 1.5j]), 0.1, 1.6)
DRAG, RATIO, PLACE, AMPLITUDE = 0.4, 0.75, 0.49, 0.1
PLACES = np.array([0.30, 0.34, 0.37, 0.40, 0.43, 0.46, PLACE])


def _film(folder: Path, named: float, speed: float, seconds: float = 5.0) -> None:
    """A film in pixels, seen from a tilted camera, with a pixel's fifth of noise."""
    time = np.arange(round(60 * seconds) + 1) / 60.0
    s = (PLACES - 0.27) / (PLACE - 0.27)
    deflection = AMPLITUDE * MADE.beat @ s ** POWERS[:, None]
    across = (deflection * np.exp(2j * np.pi * RATIO * named * time)[:, None]).real
    own = np.zeros((len(time), 2 + len(PLACES), 2))
    own[..., 0] = np.concatenate([[-0.071, 0.071], PLACES]) - speed * time[:, None]
    own[:, 2:, 1] = across
    turn = np.array([[0.8, 0.6], [-0.6, 0.8]])
    pixels = 900.0 * own @ turn * [1.0, -1.0] + 1500.0
    pixels += 0.2 * np.random.default_rng(int(100 * named)).standard_normal(pixels.shape)
    name = f"markers_f{named:.2f}".replace(".", "_")
    np.savetxt(folder / f"{name}.csv", pixels.reshape(len(time), -1), delimiter=",")


@pytest.fixture(scope="module")
def films(tmp_path_factory) -> Path:
    """A clone with four films of a fish that swims as the forces of the fluid say."""
    clone = tmp_path_factory.mktemp("fishsim")
    folder = clone / "Data" / "Markers"
    folder.mkdir(parents=True)
    for named in (0.75, 1.0, 1.5, 2.0):
        beat = Beat(RATIO * named, AMPLITUDE, PLACE, 0.08 * named)
        _film(folder, named, settled_speed(MADE, beat, DRAG))
    (folder / "rotatedMarkers_f1_00.csv").write_text("0,0\n")
    return clone


def test_beat_and_speed_are_found(films):
    """Frequency, amplitude, place, the shape of the beat, and the way along the head's axis, from any camera."""
    runs = filmed_runs(films)
    assert [run.named_frequency for run in runs] == [0.75, 1.0, 1.5, 2.0]
    seen = [seen_beat(run) for run in runs]
    for beat in seen:
        assert beat.ratio == pytest.approx(RATIO, abs=1e-3) and beat.apart
        assert beat.beat.amplitude == pytest.approx(AMPLITUDE, rel=1e-2)
        assert beat.beat.place == pytest.approx(PLACE, rel=1e-2)
    fish = fish_of(seen)
    s = np.linspace(0.2, 1.0, 9)
    turn = MADE.beat.sum() / abs(MADE.beat.sum())
    assert fish.beat @ s ** POWERS[:, None] == pytest.approx(
        MADE.beat @ s ** POWERS[:, None] / abs(MADE.beat.sum()) / turn, abs=0.03
    )


def test_a_drive_that_is_not_the_tails_is_an_error_in_every_film(films):
    """Also of five seconds of a slow one, less than three beats."""
    for run in filmed_runs(films):
        found = [f for f in check_recording(run.recording) if f.fault == "frequency of the drive"]
        assert len(found) == 1 and found[0].number == pytest.approx(RATIO, abs=0.02)


def test_the_command_compares_speeds_and_writes_recordings(films, tmp_path, capsys):
    """The drag that made the films, the speeds of those it was not fitted to, and CSV files that `check` reads."""
    out = ["--output", str(tmp_path / "fish"), "--json", str(tmp_path / "fish.json")]
    assert main([str(films), "--fitted", "1,2", *out]) == 0
    said = capsys.readouterr().out
    assert said.count("0.75 of the") == 4 and "mean |Δ speed|" in said
    found = json.loads((tmp_path / "fish.json").read_text())
    assert found["form_drag"] == pytest.approx(DRAG, rel=0.1)
    assert found["mean_unseen_error_m_per_s"] < 0.005
    assert [film["fitted"] for film in found["films"]] == [False, True, False, True]
    assert (tmp_path / "fish" / "measured_fish.png").stat().st_size > 10_000
    written = read_recording(tmp_path / "fish" / "f1_50.csv")
    assert "frequency of the drive" in {finding.fault for finding in check_recording(written)}


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("markers_f1_00.csv", "1,2,a\n", "expected rows of x, y of all markers in px"),
        ("markers_f1_00.csv", "1,2,3\n" * 70, "70 rows of 3 numbers"),
        ("markers_f1_00.csv", "1,2,3,4,5,6,7,8\n" * 20, "20 rows of 8 numbers"),
        ("markers_f1_00.csv", "1,2,1,2,5,6,7,8\n" * 70, "0 px apart"),
        ("rotatedMarkers_f1_00.csv", "0,0\n", "there is no markers_f1_00.csv or its like"),
    ],
)
def test_another_file_is_refused_in_one_sentence(tmp_path, name, content, said):
    """Text, an odd column, a short film, a head without length, a folder without films."""
    (tmp_path / name).write_text(content)
    with pytest.raises(SysidError, match=said):
        filmed_runs(tmp_path)


def test_markers_that_are_mistaken_and_films_that_are_not_there(films, tmp_path, capsys):
    """A tail whose markers the tracker exchanged teaches no shape; --fitted names films."""
    assert main([str(films), "--fitted", "3"]) == 2
    assert "no film is named 3 Hz; expected some of 0.75, 1, 1.5, 2" in capsys.readouterr().err
    run = filmed_runs(films)[0]
    markers = run.recording.markers.copy()
    markers[:, 4] = markers[:, 5]
    mistaken = type(run)(
        run.named_frequency, type(run.recording)(**{**vars(run.recording), "markers": markers})
    )
    with pytest.raises(SysidError, match="in none of the 1 runs"):
        fish_of([seen_beat(mistaken)])


def test_the_fish_has_the_mass_that_is_said():
    """Spread along its length."""
    built = swimmer(MADE, Beat(1.0, AMPLITUDE, PLACE, 0.1), DRAG)
    assert built.mass.sum() * MADE.depth == pytest.approx(MADE.mass)


@pytest.mark.skipif("FISHSIM" not in os.environ, reason="FISHSIM=DIR names no clone of srl-ethz/fishsim")
def test_the_public_films(tmp_path, capsys):
    """Eight films: all their drives are noticed, and the mean error of the speed is far below 0.134 m/s."""
    out = ["--output", str(tmp_path), "--json", str(tmp_path / "fish.json")]
    assert main([os.environ["FISHSIM"], *out]) == 0
    found = json.loads((tmp_path / "fish.json").read_text())
    assert len(found["films"]) == 8
    for film in found["films"]:
        assert film["findings"][0]["number"] == pytest.approx(0.75, abs=0.02)
    assert found["mean_error_m_per_s"] < 0.02 and found["mean_unseen_error_m_per_s"] < 0.025
