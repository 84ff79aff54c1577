# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`import hasel_sysid as h` and the notebook that uses it."""

import inspect
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import hasel_sysid
import hasel_sysid as h
import hasel_sysid.api
import numpy as np
import pytest
from hasel_recording import RecordingError
from hasel_sim.errors import ModelError, SimulationError
from hasel_sim.model import load_model
from hasel_sysid.answer.result import Improvement, Stage, Status
from hasel_sysid.api import Improved
from hasel_sysid.errors import SysidError
from hasel_sysid.testing.made_up_runs import made_up_fit

PACKAGE = Path(__file__).parents[2]
ROOT = PACKAGE.parents[2]
DOCS = Path(__file__).resolve().parents[5] / "docs"
NOTEBOOK = DOCS / "tutorial" / "first_look.ipynb"
RUNNER = """
import json, os, re, sys
(notebook,) = sys.argv[1:]
os.chdir(os.path.dirname(notebook))
names = {}
for cell in json.load(open(notebook, encoding="utf-8"))["cells"]:
    if cell["cell_type"] != "code":
        continue
    text = "".join(cell["source"])
    run = re.fullmatch(r"%run (\\S+)", text.strip())
    if run:
        path = os.path.abspath(run.group(1))
        exec(compile(open(path).read(), path, "exec"), {"__file__": path, "__name__": "__main__"})
        continue
    *lines, last = text.splitlines()
    shown = last if re.match(r"\\w+\\.plot\\(", last) else ""
    exec("\\n".join(lines if shown else [*lines, last]), names)
    if shown:
        print("PNG", eval(shown, names)._repr_png_()[:4] == b"\\x89PNG")
"""


@pytest.mark.timeout(600)
def test_the_notebook_runs(tmp_path):
    """Cell by cell in a fresh Python to which nothing was told: the drag is named and near the hidden 0.25."""
    script = tmp_path / "runner.py"
    script.write_text(RUNNER)
    bare = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "AMENT_PREFIX_PATH")}
    done = subprocess.run(
        [sys.executable, script, NOTEBOOK], env=bare, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert "quadratic_drag is missing" in done.stdout
    assert done.stdout.count("PNG True") == 3
    value = float(re.search(r"quadratic_drag.coefficient = ([\d.]+)", done.stdout).group(1))
    assert value == pytest.approx(0.25, rel=0.05)


def test_the_notebook_is_kept_without_results():
    """Outputs would be of another version; nbformat 4 with an id for every cell."""
    content = json.loads(NOTEBOOK.read_text(encoding="utf-8"))
    assert (content["nbformat"], content["nbformat_minor"]) == (4, 5)
    assert len({cell["id"] for cell in content["cells"]}) == len(content["cells"])
    assert all(cell.get("outputs", []) == [] for cell in content["cells"])


def test_every_step_is_on_the_page_with_its_arguments():
    """Names, order and defaults as in the code."""
    page = (DOCS / "reference" / "python.md").read_text(encoding="utf-8")
    for name in filter(str.islower, hasel_sysid.api.__all__):
        parts = []
        for p in inspect.signature(getattr(h, name)).parameters.values():
            star = "*" if p.kind is p.VAR_POSITIONAL else ""
            default = "" if p.default is p.empty else f"={p.default!r}".replace("'", '"')
            parts.append(f"{star}{p.name}{default}")
        assert f"| `{name}({', '.join(parts)})` |" in page, name


def test_recordings_can_be_chosen_from():
    """A slice of recordings is recordings; what is not there is said."""
    runs = h.load(ROOT / "data" / "unseen_rig" / "quadratic_drag" / "fit_*_2.0Hz.csv")
    assert len(runs) == 3
    assert len(runs[:1] + runs[2:]) == 2
    assert str(runs[:1]).count("\n") == 0
    assert runs.plot()._repr_png_().startswith(b"\x89PNG")


def test_simulating_with_a_model_that_was_never_fitted_moves(tmp_path):
    """The levels of the recordings get first guesses, not zeros; a model that was saved comes back."""
    runs = h.load(ROOT / "data" / "unseen_rig" / "quadratic_drag" / "fit_5500V_2.0Hz.csv")
    found = h.simulate(h.model(), runs, label="first guess")
    assert found.comparison.runs[0].series.simulated.std() > 0.05
    assert str(found).startswith("first guess: mean |Δ sin θ|")
    path = h.save(found.model, tmp_path / "model.yaml")
    assert h.model(path).values == found.model.values


def test_an_unknown_effect_is_answered_by_the_nearest():
    """One sentence."""
    with pytest.raises(ModelError, match="quadratic_drag"):
        h.model("swimmer", "quadratic_drg")


RUN = ROOT / "data" / "unseen_rig" / "quadratic_drag" / "fit_5500V_2.0Hz.csv"


def test_names_and_paths_will_do():
    """A model's name and a recording's path stand for what they name; anything else is refused in a sentence."""
    found = h.simulate("swimmer", str(RUN))
    assert str(found) == str(h.simulate(h.model(), h.load(RUN)))
    assert str(h.simulate(found, h.load(RUN)[0])) == str(found)
    with pytest.raises(SysidError, match=r"found a int where a model is expected: give h\.model"):
        h.simulate(3, RUN)
    with pytest.raises(SysidError, match=r"found a float where recordings are expected: give h\.load"):
        h.fit("swimmer", 0.1)


def test_everything_prints_in_short_sentences():
    """A model says what drives it and its free values; no object dumps its arrays."""
    model = h.model("swimmer", "quadratic_drag")
    assert str(model).startswith(
        "swimmer: driven by voltage_upper_v and voltage_lower_v, with the effects quadratic_drag."
    )
    assert "quadratic_drag.coefficient = " in str(model)
    assert re.fullmatch(r"<Model swimmer \+ quadratic_drag, \d+ parameters>", repr(model))
    runs = h.load(RUN)
    found = h.simulate(model, runs)
    for each in (runs, runs[0], runs[0].recording, found, found.comparison, found.comparison.runs[0]):
        assert repr(each) == str(each)
        assert len(str(each)) < 2000
        assert "array(" not in repr(each)


def test_lists_texts_and_single_names_will_do(tmp_path):
    """Wherever it is plain what is meant."""
    path = tmp_path / "lab.csv"
    path.write_text(RUN.read_text(encoding="utf-8").replace("time_s,", "Zeit,", 1))
    (run,) = h.load([path], columns="time_s=Zeit")
    assert run.run.time.tolist() == h.load(RUN)[0].run.time.tolist()
    assert str(h.model("swimmer", ["quadratic_drag"])) == str(h.model("swimmer", "quadratic_drag"))
    (only,) = h.diagnose("swimmer", RUN, effects="quadratic_drag").diagnosis.findings
    assert only.effect == "quadratic_drag"


@pytest.mark.parametrize(
    ("slip", "error", "said"),
    [
        (lambda folder: h.load(3), SysidError, "found a int where the path of a recording is expected"),
        (lambda folder: h.load(RUN, columns=["t"]), RecordingError, "found .'t'. for the names of columns"),
        (
            lambda folder: h.load(RUN, columns="time_s=Zeti"),
            RecordingError,
            "no column 'Zeti' for time_s=Zeti",
        ),
        (
            lambda folder: h.simulate("swimmer", RUN, jobs="2"),
            SimulationError,
            "'2' is no whole number from 1 on",
        ),
        (
            lambda folder: h.simulate("swimmer", RUN, jobs=-1),
            SimulationError,
            "-1 is no whole number from 1 on",
        ),
        (
            lambda folder: h.improve("swimmer", RUN, effects=[3]),
            SysidError,
            "found a int where the name of an",
        ),
        (lambda folder: h.save("swimmer", 3), SysidError, "found a int where a path is expected"),
        (
            lambda folder: h.save("swimmer", folder / "gone" / "m.yaml"),
            SysidError,
            "gone/m.yaml: No such file",
        ),
        (lambda folder: h.load(RUN).plot().save(folder / "f.xyz"), SysidError, "ends in .png, .svg or .pdf"),
        (
            lambda folder: h.load(RUN).plot().save(folder / "gone" / "f.png"),
            SysidError,
            "gone/f.png: No such",
        ),
    ],
)
def test_a_slip_is_answered_by_a_sentence(slip, error, said, tmp_path):
    """Nothing of how it is made inside."""
    with pytest.raises(error, match=said):
        slip(tmp_path)


def test_an_unknown_effect_is_refused_before_anything_is_simulated(monkeypatch):
    """Not when the fit has been waited for."""
    monkeypatch.setattr("hasel_sysid.api.steps.executor", None)
    for step in (h.diagnose, h.improve):
        with pytest.raises(ModelError, match="the nearest known one is 'quadratic_drag'"):
            step("swimmer", RUN, effects="+quadratic_drg")


def test_a_picture_prints_as_a_sentence():
    """How many panels, and what to do with it."""
    assert str(h.load(RUN).plot()) == (
        "A picture of 1 panel: a notebook shows it, and save('picture.png') writes it."
    )


def test_the_package_offers_what_the_facade_does():
    """Every name, and the same object behind it, packages of the same meaning notwithstanding."""
    for name in hasel_sysid.api.__all__:
        assert getattr(hasel_sysid, name) is getattr(hasel_sysid.api, name)
        assert name in dir(hasel_sysid)


def test_a_name_it_does_not_have_is_answered_with_those_it_has():
    """As Python does, and with what there is."""
    with pytest.raises(AttributeError, match=r"'fitted'; expected one of .* fit, improve"):
        hasel_sysid.fitted  # noqa: B018


def test_sizes_and_intervals_are_printed_as_by_the_command():
    """Of what was found missing, and of nothing else."""
    name = "quadratic_drag.coefficient"
    baseline = load_model("swimmer").with_levels(np.array([4500.0]))
    drag = baseline.with_effects("quadratic_drag").with_values({name: 0.25}, {name: 0.01})
    stages = [
        Stage((), made_up_fit(baseline, 0.03), None),
        Stage(("quadratic_drag",), made_up_fit(drag, 0.003), None),
    ]
    found = Improved(
        Improvement(stages, Status.EXPLAINED, ("quadratic_drag",), 0.02, 0.002, "What is left is noise.")
    )
    said = str(found).splitlines()
    assert said[-1] == f"  {name} = 0.250 (95 % interval 0.230 to 0.270)"
    assert len([line for line in said if " = " in line]) == 1
