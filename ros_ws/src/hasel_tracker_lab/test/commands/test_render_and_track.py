# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import cv2
import numpy as np
import pytest
from hasel_recording import Recording, read_recording, write_recording
from hasel_tracker.sources.video_source import VideoSource
from hasel_tracker.tracker_commands import calibrate, track
from hasel_tracker_lab.lab_commands import render
from hasel_tracker_lab.rendering.camera_model import CameraView
from hasel_tracker_lab.rendering.renderer import board_picture

SMALL = ["--size", "640x360", "--scale", "2.8", "--frequency", "4", "--duration", "0.7", "--rest", "0.1"]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty folder to work in."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    ("output", "more"),
    [
        ("swim.mp4", ["--noise", "2", "--quality", "75"]),
        ("swim.mp4", ["--codec", "h264"]),
        ("frames", ["--tilt", "4", "--glints", "3"]),
    ],
)
def test_what_is_rendered_is_tracked(folder, output, more):
    """A rendered video or folder of images, tracked, gives the true angle within 0.003 and the true markers.

    A reflection that crosses a marker of 6 px radius may move it by up to a pixel.
    """
    assert render([output, *SMALL, *more]) == 0
    assert track([output, "-o", "run.csv", "--frame-rate", "120"]) == 0
    run, truth = (
        read_recording("run.csv"),
        read_recording("swim_truth.csv" if "." in output else "frames_truth.csv"),
    )
    assert len(run.time_s) == len(truth.time_s) == 84
    errors = np.abs(run.markers - truth.markers)
    assert np.quantile(errors, 0.98) < 0.3
    assert errors.max() < 1.0
    if "--tilt" not in more:
        assert np.abs(run.sin_theta - truth.sin_theta).max() < 3e-3


def test_cut_annotate_and_merge(folder, capsys):
    """One call cuts to two periods, merges the drive by the lag given, and writes annotated video."""
    assert render(["swim.mp4", *SMALL]) == 0
    write_recording(
        Recording(
            "drive",
            np.array([0.0, 0.35, 0.475, 0.6, 0.725, 0.85]),
            np.zeros(6),
            np.array([[0, 0], *[[5000.0, 0], [0, 5000.0]] * 2, [5000.0, 0]]),
        ),
        "drive.csv",
    )
    arguments = ["swim.mp4", "-o", "run.mcap", "--drive", "drive.csv", "--annotate", "seen.mp4", "--cut", "4"]
    arguments += ["--lag", "-0.25"]
    assert track([*arguments, "--model", "swimmer"]) == 0
    said = capsys.readouterr().out
    assert "(as given)" in said
    assert "Cut to 60 frames" in said
    recording = read_recording("run.mcap")
    assert len(recording.time_s) == 60
    assert recording.metadata["model"] == "swimmer"
    assert float(recording.metadata["drive_lag_s"]) == pytest.approx(0.1 - 0.35, abs=1e-6)
    assert recording.voltage[0].tolist() == [5000.0, 0.0]
    assert recording.voltage[20].tolist() == [0.0, 5000.0]
    assert len(list(VideoSource("seen.mp4"))) == 84


def test_merge_by_a_lamp_in_view(folder, capsys):
    """A lamp that lights with the drive's first step gives the lag to half a frame."""
    assert render(["frames", *SMALL]) == 0
    paths = sorted(folder.glob("frames/*.png"))
    for number, path in enumerate(paths):
        image = cv2.imread(str(path))
        cv2.circle(image, (600, 30), 10, (255, 255, 255) if number >= 48 else (40, 40, 40), cv2.FILLED)
        cv2.imwrite(str(path), image)
    (folder / "drive.csv").write_text("time_s,voltage_upper_v,voltage_lower_v\n0,0,0\n0.1,5000,0\n0.6,0,0\n")
    arguments = ["frames", "-o", "run.csv", "--frame-rate", "120", "--drive", "drive.csv"]
    assert track([*arguments, "--led", "592,22,16,16"]) == 0
    assert "(from the lamp in view)" in capsys.readouterr().out
    run = read_recording("run.csv")
    assert float(run.metadata["drive_lag_s"]) == pytest.approx(0.4 - 0.1, abs=0.51 / 120)
    assert np.flatnonzero(run.voltage[:, 0] > 0.0)[0] in (47, 48)


def test_motion_of_a_recording_comes_back(folder):
    """sin θ from a simulated recording, drawn and tracked, comes back within 0.003."""
    times = np.arange(60) / 120.0
    sines = 0.35 * np.sin(2.0 * np.pi * 3.0 * times)
    write_recording(Recording("simulated", times, sines), "simulated.csv")
    assert render(["swim.mp4", *SMALL[:4], "--motion", "simulated.csv"]) == 0
    assert track(["swim.mp4", "-o", "run.csv"]) == 0
    run = read_recording("run.csv")
    assert np.abs(run.sin_theta - np.interp(run.time_s, times, sines)).max() < 3e-3


def test_csrt_is_there_for_comparison(folder):
    """--method csrt tracks the same video by the seed paper's method, with boxes found or given."""
    assert render(["swim.mp4", "--size", "640x360", "--scale", "2.8", "--duration", "0.05"]) == 0
    truth = read_recording("swim_truth.csv")
    boxes = [f"{round(x) - 8},{round(y) - 8},16,16" for x, y in truth.markers[0]]
    for more in ([], ["--box", *boxes]):
        assert track(["swim.mp4", "-o", "run.csv", "--method", "csrt", *more]) == 0
        run = read_recording("run.csv")
        assert run.metadata["tracking_method"] == "csrt"
        assert np.abs(run.markers - truth.markers).max() < 5.0


def test_colour_and_board_from_the_command_line(folder, capsys):
    """Both calibrations are learned, shown and then used; the angle of a tilted view becomes true."""
    assert render(["swim.mp4", *SMALL, "--tilt", "25", "--lens", "-0.3"]) == 0
    assert calibrate(["colour", "swim.mp4", "-o", "markers.yaml", "--show", "seen.png"]) == 0
    assert cv2.imread("seen.png").shape == (360, 640, 3)
    poses = {
        "plane": (25.0, 0.0),
        "a": (-20.0, 10.0),
        "b": (0.0, -25.0),
        "c": (10.0, 25.0),
        "d": (-30.0, -15.0),
    }
    for name, (tilt, pan) in poses.items():
        view = CameraView(640, 360, 2800.0, 0.6, np.radians(tilt), 0.0, np.radians(pan), -0.3)
        cv2.imwrite(f"{name}.png", board_picture(view, 9, 6, 0.016))
    assert (
        calibrate(["board", "a.png", "b.png", "c.png", "d.png", "--plane", "plane.png", "--square", "0.016"])
        == 0
    )
    assert "with lens distortion" in capsys.readouterr().out
    used = ["--settings", "markers.yaml", "--calibration", "camera.yaml"]
    assert track(["swim.mp4", "-o", "run.csv", *used]) == 0
    assert track(["swim.mp4", "-o", "raw.csv"]) == 0
    run, raw, truth = (read_recording(name) for name in ("run.csv", "raw.csv", "swim_truth.csv"))
    assert np.abs(run.sin_theta - truth.sin_theta).max() < 5e-3
    assert np.abs(raw.sin_theta - truth.sin_theta).max() > 2e-2


def test_metres_from_a_known_distance(folder, capsys):
    """Two points a known distance apart give metres: the tracked markers come back where they were rendered."""
    assert render(["swim.mp4", *SMALL[:4], "--duration", "0.05"]) == 0
    between = ["--between", "100,180", "380,180", "--metres", "0.1"]
    assert calibrate(["distance", "swim.mp4", *between]) == 0
    assert "0.35714 mm per pixel" in capsys.readouterr().out
    assert track(["swim.mp4", "-o", "run.csv", "--calibration", "camera.yaml"]) == 0
    run, truth = read_recording("run.csv"), read_recording("swim_truth.csv")
    assert run.marker_unit == "m"
    assert np.abs(run.markers * [2800.0, -2800.0] - truth.markers).max() < 0.3
    assert calibrate(["distance", "swim.mp4", "--between", "1,1", "1,1", "--metres", "0.1"]) == 1


@pytest.mark.parametrize(
    ("command", "arguments", "message"),
    [
        (track, ["nothing.mp4", "-o", "run.csv"], "nothing.mp4 does not exist"),
        (track, ["grey", "-o", "run.csv", "--frame-rate", "30"], "No frame of grey gives an angle"),
        (track, ["grey", "-o", "run.txt"], "neither .csv nor .mcap"),
        (track, ["grey", "-o", "run.csv", "--drive", "no.csv"], "There is no drive file no.csv"),
        (render, ["out.mp4", "--motion", "no.csv"], "no.csv"),
        (render, ["out.xyz", *SMALL], "end its name in .mp4"),
        (render, ["out.mp4", "--background", "no.png"], "background no.png is not a readable image"),
        (render, ["out.mp4", "--frame-rate", "0"], "must be positive"),
        (calibrate, ["colour", "no.png"], "There is no image no.png"),
        (
            calibrate,
            ["board", "--plane", "grey/0.png", "--square", "0.01"],
            "No board of 9 × 6 inner corners",
        ),
        (calibrate, ["board", "--plane", "grey/0.png", "--square", "0"], "expected at least 3 × 3 corners"),
    ],
)
def test_mistakes_get_one_sentence(folder, capsys, command, arguments, message):
    """Every mistake ends with exit code 1 and one sentence on stderr, without a stack trace."""
    (folder / "grey").mkdir()
    for index in range(3):
        cv2.imwrite(f"grey/{index}.png", np.full((90, 160, 3), 128, np.uint8))
    assert command(arguments) == 1
    error = capsys.readouterr().err.strip().splitlines()[-1]
    assert error.startswith("error: ")
    assert message in error


def test_csv_keeps_switches_that_fall_between_frames(folder):
    """A drive merged into a CSV file switches when it did, not at the next frame, as in an MCAP file."""
    assert render(["swim.mp4", *SMALL]) == 0
    (folder / "drive.csv").write_text(
        "time_s,voltage_upper_v,voltage_lower_v\n0,0,0\n0.1034,5000,0\n0.353,0,5000\n0.8,0,0\n"
    )
    for output in ("run.csv", "run.mcap"):
        assert track(["swim.mp4", "-o", output, "--drive", "drive.csv", "--lag", "0"]) == 0
        when, values = read_recording(output).drive()
        np.testing.assert_allclose(when[1:3], [0.1034, 0.353], atol=1e-9)
        np.testing.assert_array_equal(values[:3], [[0, 0], [5000, 0], [0, 5000]])
