# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The report's content from a diagnosis and an improvement."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_sim.model import load_model
from hasel_sysid.answer.diagnosis import Diagnosis, Finding, Verdict
from hasel_sysid.answer.result import Improvement, Stage, Status, WrongConstant
from hasel_sysid.command_line.summary import improvement_lines
from hasel_sysid.estimation import FittedModel
from hasel_sysid.model_checking import GoodnessOfFit
from hasel_sysid.noise import NoiseModel
from hasel_sysid.report.from_improvement import (
    diagnosis_content,
    improvement_content,
    ranked_rows,
    what_is_missing,
)
from hasel_sysid.report.write import render
from hasel_sysid.testing.made_up_runs import made_up_comparison, made_up_fit

DRAG = {"quadratic_drag.coefficient": (0.25, 0.004)}
UNITS = {"quadratic_drag.coefficient": "1"}


@pytest.fixture
def diagnosis() -> Diagnosis:
    """Quadratic drag is missing; a user's own effect is absent."""
    findings = [
        Finding("quadratic_drag", Verdict.MISSING, 0.93, 0.98, DRAG, UNITS, 0.4, 0.01),
        Finding("my_effect", Verdict.ABSENT, 0.01, 0.02, {}, {}, 0.1, 0.5),
    ]
    noise = NoiseModel(9e-6, 0.0, 0.5, "a test")
    groups, fit = [("quadratic_drag", "linear_drag")], _fit(load_model("swimmer").with_levels([4500.0]), 0.03)
    return Diagnosis(findings, groups, noise, noise, 0.0, 0.98, 0.99, 0.02, {}, fit)


@pytest.fixture
def improvement(diagnosis) -> Improvement:
    """Two stages: the fitted baseline, and with the drag; errors 0.03 → 0.003 and 0.04 → 0.004 on unseen runs."""
    baseline = load_model("swimmer").with_levels(np.array([4500.0]))
    drag = baseline.with_effects("quadratic_drag").with_values({"quadratic_drag.coefficient": 0.25})
    stages = [
        Stage((), _fit(baseline, 0.03), 0.04, diagnosis),
        Stage(("quadratic_drag",), _fit(drag, 0.003), 0.004),
    ]
    return Improvement(stages, Status.EXPLAINED, ("quadratic_drag",), 0.02, 0.0024, "What is left is noise.")


def _fit(model, error: float) -> FittedModel:
    return made_up_fit(model, error, at_bound=("slope",))


def test_rows_of_the_ranking(diagnosis):
    """Built-in effects bring their physics, own ones go without; values keep unit and error."""
    drag, own = ranked_rows(diagnosis)
    assert (drag.effect, drag.verdict, drag.probability) == ("quadratic_drag", "missing", 0.93)
    assert drag.physics
    assert (drag.expected[0].name, drag.expected[0].value, drag.expected[0].standard_error) == (
        "coefficient",
        0.25,
        0.004,
    )
    assert own.physics == ""


def test_stages_fall_from_the_start_to_the_last(improvement):
    """The start, the fit and every added effect are stages with both errors; the key numbers are the last ones."""
    models = [stage.fit.model for stage in improvement.stages]
    start = made_up_comparison(models[0], "swimmer", 0.08, 0.09)
    stages = [
        made_up_comparison(models[0], "fitted", 0.03, 0.04),
        made_up_comparison(models[1], "+ drag", 0.003, 0.004),
    ]
    content = improvement_content(improvement, stages, start)
    assert [(s.label, s.error, s.error_unseen) for s in content.stages] == [
        ("start", 0.08, 0.09),
        ("fit", 0.03, 0.04),
        ("+ quadratic_drag", 0.003, 0.004),
    ]
    assert "coefficient = 0.25" in content.stages[-1].note
    assert [number.value for number in content.key_numbers] == ["0.0030", "0.0040", "0.0024", "98 %"]
    assert content.title == "Missing: quadratic_drag"
    assert content.good is True
    slope = next(row for row in content.parameters if row.name == "slope")
    assert slope.remark == "on its bound"


def test_the_ranking_shows_the_values_of_the_last_model(improvement):
    """One number of one effect on the whole page: that of the fit with all that was added."""
    last = improvement.stages[-1]
    parameter = last.fit.model.parameters["quadratic_drag.coefficient"]
    fitted = replace(parameter, value=0.26, standard_error=0.005)
    model = replace(last.fit.model, parameters={**last.fit.model.parameters, parameter.name: fitted})
    stages = [improvement.stages[0], replace(last, fit=_fit(model, 0.003))]
    shown = [made_up_comparison(stage.fit.model, "", 0.03, 0.04) for stage in stages]
    drag, own = improvement_content(replace(improvement, stages=stages), shown).ranking
    assert [(row.value, row.standard_error) for row in drag.expected] == [(0.26, 0.005)]
    assert own.expected == ()


def test_rendered_improvement_and_diagnosis(improvement, diagnosis):
    """Both contents make a page with verdict, groups and what remains."""
    models = [stage.fit.model for stage in improvement.stages]
    stages = [
        made_up_comparison(models[0], "fitted", 0.03, 0.04),
        made_up_comparison(models[1], "+ drag", 0.003, 0.004),
    ]
    page = render(improvement_content(improvement, stages))
    assert "What is left is noise." in page
    assert "slope is at its" in page
    page = render(diagnosis_content(diagnosis, stages[0]))
    assert "<code>quadratic_drag</code>, <code>linear_drag</code>" in page
    assert "Probability that it is none of the listed effects: 2%." in page


def test_unexplained_is_no_good_news(improvement):
    """Nothing found is said in the title and not in green."""
    none = replace(improvement, status=Status.UNEXPLAINED, missing=())
    model = improvement.stages[0].fit.model
    content = improvement_content(none, [made_up_comparison(model, "fitted", 0.03, 0.04)])
    assert content.title == "None of the listed effects explains the measurements"
    assert content.good is False


def test_a_wrong_number_is_a_stage_of_its_own(improvement):
    """Title, verdict and terminal name it with its value and what was given; no share is said to be explained."""
    name, baseline = "material.density_kg_per_m3", improvement.stages[0].fit.model
    freed = baseline.with_freed(name).with_values({name: 1136.0}, {name: 2.0})
    constant = WrongConstant(name, 900.0, _fit(freed, 0.003), frozenset({"soft_modulus", "spine_modulus"}))
    first = replace(improvement.stages[0], diagnosis=improvement.diagnosis.of_no_effect())
    stages = [first, Stage((), constant.fit, 0.004, constant=name)]
    found = Improvement(
        stages,
        Status.UNEXPLAINED,
        (),
        1.0,
        0.0024,
        str(constant),
        goodness=GoodnessOfFit(1.0, 0.0025),
        constant=constant,
    )
    shown = [made_up_comparison(s.fit.model, "s", s.mae_fit, s.mae_validation) for s in stages]
    content = improvement_content(found, shown)
    assert content.title == f"A number of the model file is wrong: {name}"
    assert "in place of 900 kg/m^3, does as much as soft_modulus + spine_modulus" in content.verdict
    assert [stage.label for stage in content.stages] == ["fit", f"+ {name}"]
    assert "value = 1136.0 ± 2.0 kg/m^3" in content.stages[-1].note
    assert "explained" not in [number.label for number in content.key_numbers]
    assert all(row.verdict != "missing" and row.probability == 0.0 for row in content.ranking)
    assert name in render(content)
    lines = improvement_lines(found, shown, [])
    assert lines[0] == found.reason
    assert lines.count(found.reason) == 1
    assert lines[1].startswith(f"  {name} = 1136")


def test_verdict_says_why_an_effect_was_exchanged(improvement):
    """An effect that was not first at first, but fits best beside the second, is not called a mere stand-in."""
    exchanged = replace(improvement, missing=("my_effect", "quadratic_drag"))
    comparisons = [
        made_up_comparison(stage.fit.model, "s", stage.mae_fit, 0.1) for stage in improvement.stages
    ]
    verdict = improvement_content(exchanged, comparisons).verdict
    assert "my_effect fits best together with quadratic_drag" in verdict
    assert "my_effect is absent" not in verdict


def test_of_several_one_sentence_tells_which_are_known_and_which_only_perhaps(improvement):
    """A value of which the interval holds nothing at all accuses nobody for certain."""
    two = ("payload.mass", "quadratic_drag.coefficient")
    model = load_model("swimmer").with_effects("payload", "quadratic_drag")
    findings = [Finding(name.partition(".")[0], Verdict.MISSING, 0.5, 0.9, {}, {}, 0.1, 0.1) for name in two]
    diagnosis = replace(improvement.diagnosis, findings=findings)

    def said(*errors: float) -> str:
        fitted = model.with_values(dict(zip(two, (0.01, 0.25), strict=True)))
        last = Stage(
            ("payload", "quadratic_drag"),
            _fit(fitted.with_covariance(two, np.diag(np.square(errors))), 0.003),
            None,
        )
        stages = [replace(improvement.stages[0], diagnosis=diagnosis), last]
        return what_is_missing(replace(improvement, stages=stages, missing=("payload", "quadratic_drag")))

    assert said(0.001, 0.01).startswith("payload and quadratic_drag are missing: together they explain most")
    assert said(0.02, 0.01).startswith("quadratic_drag is missing, and perhaps payload: together")
    assert said(0.02, 0.5).startswith("Perhaps payload and quadratic_drag are missing: together")
    assert said(0.02, 0.5).endswith("by itself each may do nothing.")
