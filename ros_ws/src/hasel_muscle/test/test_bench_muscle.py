# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`bench_muscle` as its user calls it."""

import json

import pytest
from hasel_muscle.bench_muscle import main
from hasel_sim.model.muscle_file import load_muscle


def test_a_hidden_stiffness_is_found_in_the_public_format(bench, tmp_path, capsys):
    """Muscle from the description beside the file; picture, report, muscle file and JSON are written."""
    path = bench.hiding(parallel_stiffness__stiffness=6.0).write_mat(tmp_path)
    out = tmp_path / "out"
    options = ["--unseen-voltages", "2500,4500", "--effects", "parallel_stiffness,trapped_oil", "--all"]
    assert main([str(path), *options, "--output", str(out), "--json", str(out / "bench.json")]) == 0
    said = capsys.readouterr().out
    assert "parallel_stiffness is missing" in said
    assert "2500 V *" in said
    assert "On unseen lifts alone the law is" in said
    written = json.loads((out / "bench.json").read_text())
    assert written["verdict"] == {"status": "explained", "missing": ["parallel_stiffness"]}
    assert [stage["effects"] for stage in written["stages"]] == [[], [], ["parallel_stiffness"]]
    assert written["stages"][-1]["mae_validation"]["m"] < 5e-6
    assert load_muscle(out / "muscle.yaml").values["parallel_stiffness.stiffness"] == pytest.approx(
        6.0, rel=0.02
    )
    page = (out / "bench_muscle.html").read_text()
    assert "data:image/png;base64," in page and "http" not in page.split("</style>")[1]
    assert (out / "bench_muscle.png").stat().st_size > 10_000


def test_a_known_set_of_effects_is_only_fitted(bench, tmp_path, capsys):
    """--fit-only with --effects looks for nothing."""
    path = bench.hiding(parallel_stiffness__stiffness=6.0).write_csv(tmp_path / "a.csv")
    muscle = ["--muscle", "peano_hasel", "--fit-only", "--effects", "parallel_stiffness"]
    assert main([str(path), *muscle, "--output", str(tmp_path)]) == 0
    assert "The model describes these lifts" in capsys.readouterr().out
    assert [effect.id for effect in load_muscle(tmp_path / "muscle.yaml").effects] == ["parallel_stiffness"]


def test_other_recordings_judge(bench, tmp_path, capsys):
    """--validate takes whole recordings, under another load, that are never fitted; a bad one among them is told of."""
    fitted = bench.write_csv(tmp_path / "a.csv")
    bench.load, bench.seed = 1.0, 1
    unseen = bench.write_csv(tmp_path / "b.csv")
    (tmp_path / "bad.csv").write_text("nothing")
    options = ["--muscle", "peano_hasel", "--effects", "parallel_stiffness", "--validate"]
    files = [str(unseen), str(tmp_path / "bad.csv")]
    assert main([str(fitted), *options, *files, "--output", str(tmp_path)]) == 0
    said = capsys.readouterr()
    assert " V *" in said.out and "1 N" in said.out
    assert "warning: left out: " in said.err and "bad.csv" in said.err


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--unseen-voltages", "1234"], "no lift is at 1234 V"),
        (["--effects", "edge"], "nearest known one is 'edge_effect'"),
        (["--muscle", "peano"], "nearest known one is 'peano_hasel'"),
        (["--unseen-voltages", "1500,2000,2500,3000,3500,4000,4500,5000"], "nothing is left to fit"),
        (["--unseen-voltages", "1500,2000,2500,3000"], "lift at 4 voltages; expected 5"),
    ],
)
def test_what_cannot_be_gets_one_sentence(bench, tmp_path, capsys, options, message):
    """Exit code 2, one line on stderr."""
    path = bench.write_csv(tmp_path / "a.csv")
    assert main([str(path), "--muscle", "peano_hasel", *options, "--output", str(tmp_path)]) == 2
    (said,) = [line for line in capsys.readouterr().err.splitlines() if line.startswith("error: ")]
    assert message in said


@pytest.mark.parametrize(
    "option", [["--unseen-voltages", "much"], ["--settling", "-1"], ["--settling", "soon"]]
)
def test_options_that_are_no_numbers_are_refused(option, capsys):
    """By the parser, with an example or the range."""
    with pytest.raises(SystemExit):
        main(["a.csv", *option])
    assert option[1] in capsys.readouterr().err
