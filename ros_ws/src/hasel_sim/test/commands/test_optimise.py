"""`optimise`."""

import json
from pathlib import Path

import pytest
from hasel_sim.commands.optimise import main

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


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--model", "swimmer"], "names no fluid"),
        (["--vary", "frequency"], "'frequency' cannot be varied"),
        (["--start", "9000"], "first starts at 1.64; expected 0.4 to 1"),
    ],
)
def test_what_cannot_be_done_is_one_sentence(capsys, arguments, said):
    """A dry body, a number that is not varied, a start above the largest voltage."""
    assert main([*arguments, *QUICK]) == 1
    error = capsys.readouterr().err
    assert said in error and error.count("\n") == 1
