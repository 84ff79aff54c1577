# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import json
from dataclasses import asdict, replace

import pytest
from hasel_benchmark.bench_hidden.hidden_cases import Case
from hasel_benchmark.bench_hidden.laboratory import Laboratory
from hasel_benchmark.bench_hidden.outcome import Estimate, judge, outcome_from_dict

FLOOR = 0.0024


def outcome(hidden, kind="single", seconds=50.0, **changes):
    """A judged answer of `improve`: drag found and added, unless changed."""
    answer = {
        "noise_floor": 0.003,
        "stages": [
            {"effects": [], "parameters": {}, "mae_fit": 0.0124, "mae_validation": 0.0224},
            {
                "effects": ["quadratic_drag"],
                "parameters": {"quadratic_drag.coefficient": {"value": 0.31, "std": 0.01, "unit": "1"}},
                "mae_fit": 0.0034,
                "mae_validation": 0.0064,
            },
        ],
        "ranking": [
            {"effect": "quadratic_drag", "probability": 0.9, "error_removed": 0.9},
            {"effect": "linear_drag", "probability": 0.1, "error_removed": 0.5},
        ],
        "indistinguishable": [["quadratic_drag", "surface_friction"]],
        "verdict": {"status": "explained", "missing": ["quadratic_drag"], "unexplained_fraction": 0.05},
        **changes,
    }
    values = {name: {"coefficient": 0.3} for name in hidden if name == "quadratic_drag"}
    laboratory = Laboratory((), (), values, FLOOR, FLOOR)
    return judge(Case(kind, tuple(hidden), 1.0, 0, "white", "near"), laboratory, answer, seconds)


def verdict(status, *missing):
    """The verdict of an answer."""
    return {"status": status, "missing": list(missing), "unexplained_fraction": 0.5}


def test_right_effect_is_right():
    """Named first, added, visible, and most of the error above the noise gone."""
    found = outcome(["quadratic_drag"])
    assert found.right and found.right_within_group and found.all_named and found.visible
    assert found.removed_fitted == pytest.approx(0.9)
    assert found.removed_unseen == pytest.approx(0.8)


def test_stated_twin_counts_within_the_group_only():
    """Friction hidden and drag named: wrong, but said to be indistinguishable."""
    found = outcome(["surface_friction"])
    assert not found.right
    assert found.right_within_group
    assert found.all_named_within_group and not found.all_named


def test_another_effect_named_is_wrong():
    """An effect outside the stated groups is neither."""
    found = outcome(["charging_lag"])
    assert not found.right and not found.right_within_group and found.accuses_with_confidence


def test_ranking_counts_for_nothing_when_nothing_is_said_to_be_missing():
    """Who says that nothing is missing has named nobody."""
    found = outcome(["quadratic_drag"], verdict=verdict("nothing_missing"))
    assert not found.reports_something
    assert not found.right


@pytest.mark.parametrize(
    ("status", "missing", "accuses", "none"),
    [
        ("explained", ["quadratic_drag"], True, False),
        ("partly_explained", ["quadratic_drag"], False, True),
        ("unexplained", [], False, True),
        ("nothing_missing", [], False, False),
    ],
)
def test_answers_to_an_effect_that_no_catalogue_lists(status, missing, accuses, none):
    """Only `explained` accuses with confidence; silence is not the same as `none of them`."""
    found = outcome(["stirred_bath"], "unlisted", verdict=verdict(status, *missing))
    assert (found.accuses_with_confidence, found.says_none_of_them) == (accuses, none)


def test_effect_swallowed_by_the_parameters_is_not_visible():
    """What is left must exceed the noise by half its rms: a mean of 0.0026 over 0.0024 does not, 0.0028 does."""
    stage = {"effects": [], "parameters": {}, "mae_validation": 0.003}
    assert not outcome(["tether"], stages=[{**stage, "mae_fit": 0.0026}]).visible
    assert outcome(["tether"], stages=[{**stage, "mae_fit": 0.0028}]).visible


def test_interval_covers_within_two_standard_errors():
    """0.31 ± 0.01 covers 0.30; not 0.28; and no interval says nothing."""
    assert outcome(["quadratic_drag"]).estimates[0].covered
    assert not Estimate("x", 0.31, 0.01, 0.28).covered
    assert Estimate("x", 0.31, None, 0.31).covered is None


def test_survives_being_kept_in_a_file():
    """What is written as JSON is read back the same."""
    found = outcome(["quadratic_drag"])
    assert outcome_from_dict(json.loads(json.dumps(asdict(found)))) == found


@pytest.mark.parametrize(
    ("fault", "missing", "said", "named", "exact"),
    [
        ("dead_upper_channel", (), "the upper channel is dead in run 2", True, True),
        ("dead_upper_channel", ("quadratic_drag",), "the upper channel is dead in run 2", True, False),
        ("dead_upper_channel", ("muscle_asymmetry",), "", False, False),
        ("early_clock", ("camera_latency",), "", True, True),
        ("early_clock", ("charging_lag",), "", False, False),
    ],
)
def test_a_fault_of_the_set_up_is_named_by_its_words_or_as_the_effect_that_it_is(
    fault, missing, said, named, exact
):
    """Clocks that differ in every run alike are an effect of the catalogue; nothing is beside it."""
    found = replace(outcome([], "set_up"), fault=fault, missing=missing, set_up=said)
    assert (found.fault_named, found.exact) == (named, exact)
