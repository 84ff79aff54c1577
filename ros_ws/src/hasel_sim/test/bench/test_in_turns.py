# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Two versions of the simulator, timed in turns."""

import json

import pytest
from hasel_sim.commands import entry

OTHER = """
import types, sys
simulate = types.ModuleType("hasel_sim.simulate")
simulate.simulate = lambda model, run, names=(): sum(range(200_000))
sys.modules["hasel_sim.simulate"] = simulate
cases = types.ModuleType("hasel_sim.bench.cases")
cases.fitted_swimmer = lambda: types.SimpleNamespace(parameters={"slope": 1.0})
cases.box_run = lambda *drive: None
cases.node_count = lambda model: 336
sys.modules["hasel_sim.bench"] = types.ModuleType("hasel_sim.bench")
sys.modules["hasel_sim.bench.cases"] = cases
"""
"""An earlier version, which has no lanes: a run takes as long as such a sum."""


@pytest.fixture
def clone(tmp_path):
    """A clone of an earlier revision."""
    package = tmp_path / "ros_ws" / "src" / "hasel_sim" / "hasel_sim"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text(OTHER, encoding="utf-8")
    return tmp_path


def test_the_other_version_is_timed_in_its_own_process(clone, tmp_path, capsys):
    """Its four runs cost four times one, for it has no lanes; this version's cost less than that."""
    path = tmp_path / "ratios.json"
    assert entry.bench(["--against", str(clone), "--json", str(path)]) == 0
    assert "336 nodes there, 275 here" in capsys.readouterr().out
    content = json.loads(path.read_text(encoding="utf-8"))
    there, here = content["other_s"], content["own_s"]
    assert there["many"] == pytest.approx(4 * there["forward"], rel=0.5)
    assert here["many"] < 3 * here["forward"]
    assert content["ratios"]["many"] == pytest.approx(there["many"] / here["many"])


def test_what_is_no_checkout_is_said(tmp_path, capsys):
    """One sentence, with what to give."""
    assert entry.bench(["--against", str(tmp_path)]) == 1
    assert "There is no simulator in" in capsys.readouterr().err


def test_a_version_that_cannot_be_timed_is_said(clone, capsys):
    """Its own words are not swallowed."""
    (clone / "ros_ws/src/hasel_sim/hasel_sim/__init__.py").write_text(
        "raise ImportError('no torch')", encoding="utf-8"
    )
    assert entry.bench(["--against", str(clone)]) == 1
    assert "could not be timed" in capsys.readouterr().err
