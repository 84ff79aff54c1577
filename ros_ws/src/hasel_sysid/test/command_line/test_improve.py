# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The commands `improve` and `diagnose` from end to end, on a coarse model with a hidden effect."""

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from hasel_sim.model import load_model
from hasel_sysid.command_line import diagnose, improve

PAGE = (Path(__file__).resolve().parents[5] / "docs" / "reference" / "json.md").read_text(encoding="utf-8")
OWN = '''
import numpy as np
from hasel_sim.effects.base import EffectParameter, ForceEffect


class WaveDrag(ForceEffect):
    """Drag that grows with the third power of the normal velocity."""

    id = "wave_drag"
    physics = "Waves carry energy away from the moving surface."
    equation = "f = -c |v.n|^2 (v.n) n per skin length"
    parameters = (EffectParameter("coefficient", "c", "N s^3/m^5", 0.0, 0.0, 1e5, 500.0),)
    sites = "skin"
    depends_on = ("velocity",)

    def force(self, at, p):
        speed = np.sum(at.velocity * at.rest_normal, axis=1)
        return (-p.coefficient * speed**3)[:, None] * at.rest_normal
'''


def improved(laboratory, output: Path, rivals: str) -> dict:
    """The content of `improve --json`, with one unseen run."""
    unseen = ["--validate", str(laboratory.folder / "4500V_1.5Hz.csv")]
    written = ["--output", str(output), "--json", str(output / "i.json")]
    assert improve.main([*laboratory.arguments(rivals), *unseen, *written]) == 0
    return json.loads((output / "i.json").read_text())


def keys(content: object) -> Iterator[str]:
    """Every key, however deep, but names of parameters, channels and kinds of failures."""
    if isinstance(content, dict):
        for key, value in content.items():
            yield key
            yield from () if key in ("parameters", "expected", "drive", "suspects", "detail") else keys(value)
    elif isinstance(content, list):
        for each in content:
            yield from keys(each)


@pytest.fixture(scope="module")
def with_waves(tmp_path_factory, record):
    """A swimmer with an effect that stands in no catalogue but in a file of the user's."""
    folder = tmp_path_factory.mktemp("waves")
    (folder / "wave_drag.py").write_text(OWN)
    return record(folder, f"{folder}/wave_drag.py:WaveDrag", {"wave_drag.coefficient": 400.0})


def test_improve_adds_the_hidden_effect(with_drag, tmp_path, capsys):
    """The drag is named, added with its value, and the error falls to the noise on fitted and unseen runs."""
    content = improved(with_drag, tmp_path, "muscle_asymmetry")
    assert content["verdict"]["status"] == "explained"
    assert content["verdict"]["missing"] == ["quadratic_drag"]
    first, last = content["stages"][0], content["stages"][-1]
    drag = last["parameters"]["quadratic_drag.coefficient"]
    assert drag["value"] == pytest.approx(0.25, rel=0.03)
    assert last["mae_fit"] < 0.002 < 0.1 * first["mae_fit"]
    assert last["mae_validation"] < 0.002
    assert content["where_it_fails"]
    assert content["start"]["mae_fit"] > first["mae_fit"]
    assert "Missing: quadratic_drag" in (tmp_path / "report.html").read_text(encoding="utf-8")
    assert load_model(tmp_path / "improved_model.yaml").effects[0].id == "quadratic_drag"
    lines = [json.loads(line) for line in (tmp_path / "ledger.jsonl").read_text().splitlines()]
    assert [line["effects"] for line in lines] == [[], ["quadratic_drag"]]
    for line in lines:
        load_model(tmp_path / line["model"])
    assert {"waterfall.png", "error_by_stage.png"} <= {path.name for path in tmp_path.iterdir()}
    said = capsys.readouterr().out
    assert said.startswith("quadratic_drag is missing")
    assert "quadratic_drag.coefficient = 0.2" in said and "(95 % interval 0.2" in said
    assert "on fitted runs: 0." in said and "on unseen runs: 0." in said and " before, 0.00" in said
    assert "muscle_asymmetry is" not in said and "--all" in said
    assert {key for key in keys(content) if f"`{key}`" not in PAGE} == set()


def test_improve_adds_an_effect_of_the_users_own(with_waves, tmp_path):
    """An effect from a file of the user's is ranked, added, fitted and written to the model like the built-in ones."""
    content = improved(with_waves, tmp_path, "muscle_asymmetry,linear_drag")
    assert content["ranking"][0]["effect"] == "wave_drag"
    assert content["verdict"]["missing"] == ["wave_drag"]
    first, last = content["stages"][0], content["stages"][-1]
    assert last["mae_validation"] < 0.002 < 0.2 * first["mae_validation"]
    model = load_model(tmp_path / "improved_model.yaml")
    assert model.effects[0].id == "wave_drag"
    assert model.values["wave_drag.coefficient"] == pytest.approx(400.0, rel=0.1)


def test_diagnose_says_what_a_person_needs_and_with_all_the_rest(with_drag, tmp_path, capsys):
    """Verdict, value with its interval, errors; tables and every effect behind --all. The noise may be given."""
    given = [*with_drag.arguments("muscle_asymmetry"), "--output", str(tmp_path), "--noise", "0.002"]
    assert diagnose.main(given) == 0
    brief = capsys.readouterr().out
    assert brief.startswith("quadratic_drag is missing")
    assert "(95 % interval" in brief and "noise floor: 0.0016" in brief
    assert "muscle_asymmetry is" not in brief and "┃ run" not in brief
    assert diagnose.main([*given, "--all"]) == 0
    whole = capsys.readouterr().out
    assert "muscle_asymmetry is" in whole and "┃ run" in whole and "0.002 rms" in whole
    assert whole.endswith(
        brief.split("(tables")[0] + whole.rpartition("Wrote")[1] + whole.rpartition("Wrote")[2]
    )
