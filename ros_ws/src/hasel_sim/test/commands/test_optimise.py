# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`optimise`."""

import json
from pathlib import Path

import pytest
from hasel_sim.commands.entry import optimise as main
from hasel_sim.model import load_model
from hasel_sim.swimming.boxes import Boxes
from hasel_sim.swimming.free_swim import free_swim

FISH = Path(__file__).parents[2] / "docs" / "bodies" / "asymmetric_fish.yaml"
QUICK = ["--frequency", "2", "--duration", "2.1", "--density", "0.4", "--most", "2"]


def test_a_straight_swim_is_found_confirmed_and_written(tmp_path, capsys):
    """Before and after on the model's own mesh, every try with its numbers, and a file that can be played."""
    out = [*("--output", str(tmp_path / "w.csv"), "--json", str(tmp_path / "w.json")), "--play", "3"]
    assert main(["--model", str(FISH), "--turning", "0", *QUICK, *out]) == 0
    said = capsys.readouterr().out
    assert "On the model's own mesh" in said and "RunExperiment plays" in said
    found = json.loads((tmp_path / "w.json").read_text())
    assert abs(found["after"]["turning"]) < 0.5 * abs(found["before"]["turning"])
    assert found["drive"]["second"] > found["drive"]["first"]
    rows = (tmp_path / "w.csv").read_text().splitlines()
    assert rows[0] == "time_s,voltage_upper_v,voltage_lower_v"
    assert rows[-1] == "3,0,0" and len(rows) == 2 + 12


def test_a_body_is_found_and_written_as_a_model(tmp_path, capsys):
    """A deeper fish with another fin, no waveform file; the model it wrote swims as it said."""
    out = ["--body", str(tmp_path / "b.yaml"), "--json", str(tmp_path / "b.json")]
    vary = ["--vary", "body.depth_m=0.04:0.06,body.spine.fin_length_m", "--output", str(tmp_path / "w.csv")]
    assert main(["--model", str(FISH), *vary, *QUICK, *out]) == 0
    said = capsys.readouterr().out
    assert "the model with the body that was found" in said and not (tmp_path / "w.csv").exists()
    found, written = json.loads((tmp_path / "b.json").read_text()), load_model(tmp_path / "b.yaml")
    body = written.description.body
    assert found["values"]["body.depth_m"] == pytest.approx(body.depth_m)
    assert found["values"]["body.spine.fin_length_m"] == pytest.approx(body.spine.fin_length_m)
    assert found["after"]["speed"] > found["before"]["speed"]
    swum = free_swim(written, Boxes(5000.0, 5000.0, 2.0).run(written, 4.2), 2.0)
    assert swum.speed == pytest.approx(found["after"]["speed"])


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--model", "swimmer"], "names no fluid"),
        (["--vary", "frequency"], "'frequency' cannot be varied"),
        (["--vary", "body.spine.fin_lenght_m"], "the nearest known one is 'body.spine.fin_length_m'"),
        (["--start", "9000"], "first starts at 9000; expected 2200 to 5500"),
    ],
)
def test_what_cannot_be_done_is_one_sentence(capsys, arguments, said):
    """A dry body, a number that is not varied, a start above the largest voltage."""
    assert main([*arguments, *QUICK]) == 1
    error = capsys.readouterr().err
    assert said in error and error.count("\n") == 1
