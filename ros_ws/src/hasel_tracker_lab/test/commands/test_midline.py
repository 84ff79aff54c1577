# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A swimmer without dots from the command line."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
import yaml
from hasel_recording import read_recording
from hasel_tracker.tracker_commands import calibrate, track
from hasel_tracker_lab.scenes.lab_scene import LabScene
from hasel_tracker_lab.scenes.scene_catalogue import BARE

SCENE = LabScene(
    (replace(BARE, length_px=420.0, start_px=(110.0, 180.0)),), size_px=(640, 360), exposure_s=0.0
)


@pytest.fixture
def truth(tmp_path, monkeypatch):
    """A folder `swim` of twelve pictures, and what they show."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "swim").mkdir()
    frames = list(SCENE.frames(12))
    for number, frame in enumerate(frames):
        cv2.imwrite(f"swim/{number:03d}.png", frame.image)
    return frames


@pytest.mark.parametrize("output", ["run.csv", "run.mcap"])
def test_points_are_recorded_like_markers(truth, output, capsys):
    """Points at the shares given come out in the recording, with the angle of every frame."""
    arguments = [
        "swim",
        "-o",
        output,
        "--frame-rate",
        "120",
        "--method",
        "midline",
        "--points",
        "0.05,0.5,0.97",
    ]
    assert track(arguments) == 0
    assert "0 without an angle" in capsys.readouterr().out
    run = read_recording(output)
    assert run.metadata["tracking_method"] == "midline"
    assert np.abs(run.sin_theta - [each.sin_theta for each in truth]).max() < 3e-3
    assert np.abs(run.markers - [each.dots_px for each in truth]).max() < 1.5


def test_how_the_body_stands_out_is_learned_and_used(truth, capsys):
    """`calibrate body` says what it sees, draws it, and its settings are used by `track`."""
    assert calibrate(["body", "swim/000.png", "--show", "seen.png"]) == 0
    assert "A dark body of 4" in capsys.readouterr().out
    assert (cv2.imread("seen.png") == (255, 0, 255)).all(axis=2).sum() > 500
    assert yaml.safe_load(Path("markers.yaml").read_text())["/**"]["ros__parameters"]["body"] == "dark"
    more = ["--frame-rate", "120", "--method", "midline", "--points", "7"]
    assert track(["swim", "-o", "run.csv", *more, "--settings", "markers.yaml"]) == 0
    assert read_recording("run.csv").markers.shape == (12, 7, 2)
    assert calibrate(["body", "swim/000.png", "--body", "light"]) == 1
    assert "No swimmer was found" in capsys.readouterr().err


def test_points_belong_to_midline(truth, capsys):
    """--points with another method is a mistake that is told."""
    assert track(["swim", "-o", "run.csv", "--frame-rate", "120", "--points", "4"]) == 1
    assert "of --method midline" in capsys.readouterr().err
