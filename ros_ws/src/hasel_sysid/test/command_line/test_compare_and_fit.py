# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The commands `compare` and `fit` from end to end, on short recordings."""

import json
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hasel_common.progress import Workload
from hasel_recording import Recording, read_recording, write_recording
from hasel_recording.command_line import convert_main
from hasel_sim.model import load_model, save_model
from hasel_sysid.command_line import compare, fit
from hasel_sysid.command_line.running import MISLEADING

FREQUENCY = 2.0


@pytest.fixture(scope="module")
def folder(tmp_path_factory, coarse, record_boxes) -> Path:
    """A coarse model with known parameters, and recordings of it with noise at three voltages."""
    folder = tmp_path_factory.mktemp("runs")
    values = {"amplitude_3500": 0.027, "amplitude_5500": 0.062, "slope": 0.3}
    truth = coarse.with_levels(np.array([3500.0, 5500.0])).with_values(values)
    save_model(truth, folder / "truth.yaml")
    save_model(coarse, folder / "coarse.yaml")
    for seed, voltage in enumerate((3500.0, 5500.0, 4250.0)):
        record_boxes(truth, folder / f"run_{voltage:.0f}.csv", voltage, FREQUENCY, 1.5, seed)
    return folder


def _arguments(folder: Path, model: str) -> list[str]:
    runs = [str(folder / f"run_{voltage}.csv") for voltage in (3500, 5500)]
    return [*runs, "--validate", str(folder / "run_4250.csv"), "--model", str(folder / model), "--jobs", "1"]


def test_compare_writes_report_and_json(folder, tmp_path, capsys):
    """The right model leaves the noise on seen and unseen runs; the report and the JSON file say the same."""
    arguments = _arguments(folder, "truth.yaml")
    assert compare.main([*arguments, "--output", str(tmp_path), "--json", str(tmp_path / "c.json")]) == 0
    content = json.loads((tmp_path / "c.json").read_text())
    noise = 0.002 * np.sqrt(2 / np.pi)
    assert content["mae_fit"] == pytest.approx(noise, rel=0.2)
    assert content["mae_validation"] == pytest.approx(noise, rel=0.3)
    assert [run["unseen"] for run in content["runs"]] == [False, False, True]
    printed = capsys.readouterr().out
    assert f"{content['mae_fit']:.5f}" in printed
    assert f"{content['mae_fit']:.5f}" in (tmp_path / "report.html").read_text(encoding="utf-8")


def test_compare_two_models(folder, tmp_path, capsys):
    """Two models are compared side by side; the file holds both."""
    arguments = [*_arguments(folder, "truth.yaml"), "--model", str(folder / "coarse.yaml")]
    assert compare.main([*arguments, "--output", str(tmp_path), "--json", str(tmp_path / "c.json")]) == 0
    models = json.loads((tmp_path / "c.json").read_text())["models"]
    assert [model["model"] for model in models] == ["truth", "coarse"]
    assert models[1]["mae_fit"] > 5 * models[0]["mae_fit"]
    assert "coarse" in capsys.readouterr().out


def test_fit_finds_the_parameters(folder, tmp_path, capsys):
    """Amplitudes and slope come out within their stated errors, and the written model compares as well as the truth."""
    arguments = _arguments(folder, "coarse.yaml")
    assert fit.main([*arguments, "--output", str(tmp_path), "--json", str(tmp_path / "f.json")]) == 0
    content = json.loads((tmp_path / "f.json").read_text())
    for name, true in {"amplitude_3500": 0.027, "amplitude_5500": 0.062, "slope": 0.3}.items():
        found = content["parameters"][name]
        assert abs(found["value"] - true) < 4 * found["std"]
        assert found["std"] < 0.1 * true
    assert content["mae_validation"] < 0.003
    model = load_model(tmp_path / "fitted_model.yaml")
    assert model.values["slope"] == content["parameters"]["slope"]["value"]
    assert "±" in capsys.readouterr().out


def test_unreadable_recording_is_skipped(folder, tmp_path, capsys):
    """A broken file among good ones is named in one line, and the rest is compared."""
    broken = tmp_path / "broken.csv"
    broken.write_text("time_s,sin_theta\n0,zero\n")
    arguments = [str(broken), *_arguments(folder, "truth.yaml"), "--output", str(tmp_path)]
    assert compare.main(arguments) == 0
    assert capsys.readouterr().err.startswith(f"warning: Skipped: {broken}")


def test_faults_of_the_set_up_come_first_and_once(folder, tmp_path, capsys):
    """A flipped recording is an error on stderr, once, before it is fitted, in the JSON file and by the exit code."""
    recording = read_recording(folder / "run_3500.csv")
    path = tmp_path / "flipped.csv"
    write_recording(replace(recording, sin_theta=-recording.sin_theta), path)
    arguments = [str(path), "--model", str(folder / "truth.yaml"), "--jobs", "1", "--output", str(tmp_path)]
    assert fit.main([*arguments, "--json", str(tmp_path / "f.json")]) == MISLEADING
    said = capsys.readouterr().err
    assert said.startswith("error: flipped: sign flip or swapped channels")
    assert said.count("the body first bends away") == 1
    gate = json.loads((tmp_path / "f.json").read_text())["data_gate"]
    assert gate[0]["fault"] == "sign flip or swapped channels"


@pytest.mark.parametrize(
    ("run", "options", "said"),
    [
        ("nowhere.csv", [], "nowhere.csv"),
        ("run_3500.csv", ["--model", "swimer"], "the nearest known one is 'swimmer'"),
        ("run_3500.csv", ["--scheduler", "tcp://127.0.0.1:9"], "no Dask scheduler"),
        ("run_3500.csv", ["--validate", "nowhere.mcap"], "nowhere.mcap"),
    ],
)
def test_bad_input_is_one_sentence(folder, tmp_path, capsys, run, options, said):
    """A missing file, an unknown model and a dead scheduler give exit code 2 and one sentence."""
    assert compare.main([str(folder / run), *options, "--output", str(tmp_path)]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert "Traceback" not in error
    assert list(tmp_path.iterdir()) == []


def test_a_header_does_not_run_code(folder, tmp_path, monkeypatch, capsys):
    """A recording from elsewhere names a model whose effect is a file beside it."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "x.yaml").write_text(
        (folder / "coarse.yaml").read_text().replace("effects: []", "effects: ['x.py:X']")
    )
    (tmp_path / "x.py").write_text("raise SystemExit('it ran')")
    run = read_recording(folder / "run_3500.csv")
    stranger = Recording("s", run.time_s, run.sin_theta, run.voltage, metadata={"model": "x.yaml"})
    write_recording(stranger, tmp_path / "stranger.csv")
    for words in ([], ["--model", ""]):
        assert compare.main(["stranger.csv", "--jobs", "1", *words]) == 2
        assert "is code that would run: give --model x.yaml if that is meant" in capsys.readouterr().err


def test_header_names_the_model(folder, tmp_path, capsys):
    """Without --model the recordings' header decides: a driven run that says beam is refused as a beam."""
    recording = read_recording(folder / "run_3500.csv")
    path = tmp_path / "beam.csv"
    write_recording(
        Recording(
            "beam", recording.time_s, recording.sin_theta, recording.voltage, metadata={"model": "beam"}
        ),
        path,
    )
    assert compare.main([str(path), "--output", str(tmp_path), "--jobs", "1"]) == 2
    assert "model 'beam' has no muscles" in capsys.readouterr().err


def test_a_model_that_was_never_fitted_is_said_first(folder, tmp_path, capsys):
    """First guesses are called so before their errors are shown; a fitted model is not."""
    run = str(folder / "run_3500.csv")
    assert compare.main([run, "--model", str(folder / "coarse.yaml"), "--output", str(tmp_path)]) == 0
    assert "note: model 'coarse' was never fitted" in capsys.readouterr().err
    assert compare.main([run, "--model", str(folder / "truth.yaml"), "--output", str(tmp_path)]) == 0
    assert "never fitted" not in capsys.readouterr().err


def test_the_drive_may_be_a_file_of_its_own(folder, tmp_path, capsys):
    """Angles and drive in two files, with other names and units, compare as the one file does."""
    model = [
        "--model",
        str(folder / "truth.yaml"),
        "--output",
        str(tmp_path),
        "--json",
        str(tmp_path / "c.json"),
    ]
    whole = read_recording(folder / "run_3500.csv")
    angles = "".join(
        f"{t};{np.degrees(np.arcsin(s))}\n" for t, s in zip(whole.time_s, whole.sin_theta, strict=True)
    )
    (tmp_path / "angles.csv").write_text("t;angle_deg\n" + angles.replace(".", ","))
    drive = "".join(
        f"{1e3 * t},{u / 1e3},{v / 1e3}\n" for t, (u, v) in zip(whole.time_s, whole.voltage, strict=True)
    )
    (tmp_path / "drive.csv").write_text("time_ms,voltage_upper_kv,voltage_lower_kv\n" + drive)
    mapping = ["--map", "time=t,sin_theta=angle_deg", "--drive", str(tmp_path / "drive.csv")]
    assert compare.main([str(folder / "run_3500.csv"), *model]) == 0
    expected = json.loads((tmp_path / "c.json").read_text())["mae_fit"]
    assert compare.main([str(tmp_path / "angles.csv"), *mapping, *model]) == 0
    assert json.loads((tmp_path / "c.json").read_text())["mae_fit"] == pytest.approx(expected, rel=1e-6)


def test_convert_goes_both_ways(folder, tmp_path):
    """CSV to MCAP and back gives the same numbers."""
    source = folder / "run_3500.csv"
    assert convert_main([str(source), "--output", str(tmp_path)]) == 0
    assert convert_main([str(tmp_path / "run_3500.mcap"), "--output", str(tmp_path / "back.csv")]) == 0
    before, after = read_recording(source), read_recording(tmp_path / "back.csv")
    np.testing.assert_allclose(after.sin_theta, before.sin_theta, rtol=0, atol=0)
    np.testing.assert_allclose(after.time_s, before.time_s, atol=1e-9)


@pytest.fixture
def interrupted_after(monkeypatch):
    """Let Ctrl-C come when a command tells how far it is for the n-th time."""

    def interrupt(command, calls: int) -> None:
        @contextmanager
        def bar(title: str, plan, usual_speed: float):
            left = iter(range(calls))

            def show(text: str, share: float) -> None:
                if next(left, None) is None:
                    raise KeyboardInterrupt

            yield Workload(plan, tell=show)

        monkeypatch.setattr(command, "progress_bar", bar)

    return interrupt


def test_ctrl_c_leaves_the_best_model(folder, tmp_path, capsys, interrupted_after):
    """A fit that is interrupted says so in one line and leaves the best model so far."""
    interrupted_after(fit, 5)
    assert fit.main([*_arguments(folder, "coarse.yaml"), "--output", str(tmp_path)]) == 130
    assert "wrote the best model so far" in capsys.readouterr().err
    assert load_model(tmp_path / "fitted_model.yaml").values["slope"] != 1.0
    assert not (tmp_path / "report.html").exists()


def test_ctrl_c_before_anything_is_known(folder, tmp_path, capsys, interrupted_after):
    """An interrupt during the first comparison writes nothing and ends with 130."""
    interrupted_after(compare, 0)
    assert compare.main([*_arguments(folder, "truth.yaml"), "--output", str(tmp_path)]) == 130
    assert list(tmp_path.iterdir()) == []


def test_ctrl_c_keeps_the_models_compared_so_far(folder, tmp_path, capsys, interrupted_after):
    """An interrupt during the second of two models reports the first."""
    interrupted_after(compare, 4)
    arguments = [*_arguments(folder, "truth.yaml"), "--model", str(folder / "coarse.yaml")]
    assert compare.main([*arguments, "--output", str(tmp_path)]) == 130
    assert "1 of 2 models were compared" in capsys.readouterr().err
    assert "truth against 3 recordings" in (tmp_path / "report.html").read_text(encoding="utf-8")
