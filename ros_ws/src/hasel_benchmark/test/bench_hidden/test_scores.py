# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The numbers of the benchmark, and the page that shows them."""

from dataclasses import replace

import pytest
from hasel_benchmark.bench_hidden.outcome import Estimate, Outcome
from hasel_benchmark.bench_hidden.results_page import as_json, as_markdown
from hasel_benchmark.bench_hidden.scores import Bar, bars, confusion, reliability
from statsmodels.stats.proportion import proportion_confint


def outcome(kind, hidden=(), first=None, status="explained", colour="white", **changes):
    """One outcome; the effect named first is the one added."""
    named = (first,) if first else ()
    content = {
        "case": f"{kind}-{'+'.join(hidden)}",
        "size": 1.0,
        "colour": colour,
        "numerics": "near",
        "status": status,
        "missing": named if status in ("explained", "partly_explained") else (),
        "ranked": named,
        "mae_fitted": (0.0104, 0.0028),
        "mae_unseen": (0.0104, 0.0039),
        "floor_fitted": 0.0024,
        "floor_unseen": 0.0024,
        "seconds": 60.0,
    }
    return Outcome(kind=kind, hidden=tuple(hidden), **{**content, **changes})


def value(outcomes, words):
    """The measured number whose description begins so, and whether its bar is met."""
    found = next(bar for bar in bars(outcomes) if bar.what.startswith(words))
    return found.value, found.met


def test_shares_of_right_answers():
    """Three of four right, the fourth an unlisted effect: 75 %, below the bar of 95 %."""
    outcomes = [outcome("single", ["gain_drift"], "gain_drift")] * 3 + [
        outcome("single", ["gain_drift"], "tether")
    ]
    assert value(outcomes, "one visible effect") == (0.75, False)


def test_false_alarms_are_counted_by_colour():
    """One alarm in fifty under white noise passes, one in ten under coloured noise does not."""
    quiet = {"status": "nothing_missing", "mae_fitted": (0.0024, 0.0024)}
    outcomes = [outcome("nothing", **quiet)] * 49 + [outcome("nothing", first="tether")]
    outcomes += [outcome("nothing", colour="coloured", **quiet)] * 9
    outcomes += [outcome("nothing", first="tether", colour="coloured")]
    assert value(outcomes, "nothing hidden, white") == (0.02, True)
    assert value(outcomes, "nothing hidden, coloured") == (0.1, False)


def test_effects_swallowed_by_the_parameters_do_not_count_against_the_naming():
    """They are counted by themselves: whether a wrong effect was accused."""
    hidden = outcome("single", ["tether"], status="nothing_missing", mae_fitted=(0.0024, 0.0024))
    wrong = outcome("single", ["tether"], "gain_drift", mae_fitted=(0.0024, 0.0024))
    outcomes = [hidden, wrong, outcome("single", ["gain_drift"], "gain_drift")]
    assert value(outcomes, "one visible effect") == (1.0, True)
    assert value(outcomes, "one effect hidden that leaves hardly") == (0.5, None)


def test_removed_error_and_intervals():
    """97.5 % removed on fitted runs, 81 % on unseen ones, too little; two of three intervals cover."""
    estimates = (Estimate("a", 1.0, 0.1, 1.1), Estimate("b", 1.0, 0.1, 1.15), Estimate("c", 1.0, 0.1, 2.0))
    found = {"mae_fitted": (0.0104, 0.0026), "estimates": estimates}
    outcomes = [outcome("single", ["gain_drift"], "gain_drift", **found)]
    assert value(outcomes, "excess error removed, fitted") == (pytest.approx(0.975), True)
    assert value(outcomes, "excess error removed, unseen") == (pytest.approx(0.8125), False)
    assert value(outcomes, "95 % intervals") == (pytest.approx(2 / 3), False)


def test_nothing_measured_is_said():
    """Without cases of a kind there is neither a number nor a met bar."""
    assert value([outcome("single", ["tether"], "tether")], "two effects") == (None, None)


def test_confusion_tells_apart_nothing_none_of_them_and_names():
    """What was named first, by what was hidden."""
    table = confusion(
        [
            outcome("nothing", status="nothing_missing"),
            outcome("unlisted", ["stirred_bath"], status="unexplained"),
            outcome("single", ["linear_drag"], "quadratic_drag"),
            outcome("single", ["linear_drag"], "linear_drag"),
        ]
    )
    assert table == {
        "nothing": {"nothing": 1},
        "stirred_bath": {"none of them": 1},
        "linear_drag": {"quadratic_drag": 1, "linear_drag": 1},
    }


def test_a_case_without_an_answer_is_reported_and_not_counted():
    """A truth that cannot be simulated stands on the page, and in no share."""
    outcomes = [
        outcome("single", ["gain_drift"], "gain_drift"),
        outcome("single", ["tether"], failure="it broke"),
    ]
    assert value(outcomes, "one visible effect") == (1.0, True)
    assert "it broke" in as_markdown(outcomes, len(outcomes))
    assert as_json(outcomes)["near"]["failures"] == ["single-tether: it broke"]


def test_page_shows_settings_apart():
    """The easier and the harder truth never share a number."""
    outcomes = [
        outcome("single", ["gain_drift"], "gain_drift"),
        outcome("single", ["gain_drift"], "tether", numerics="converged"),
    ]
    content = as_json(outcomes)
    assert [content[name]["bars"][0]["value"] for name in ("near", "converged")] == [1.0, 0.0]
    assert "## Truth: near" in as_markdown(outcomes, len(outcomes)) and "## Truth: converged" in as_markdown(
        outcomes, len(outcomes)
    )


def test_a_benchmark_broken_off_says_so():
    """How many of the planned cases the numbers rest on."""
    outcomes = [outcome("nothing", status="nothing_missing")]
    assert "1 of 40 cases have been run" in as_markdown(outcomes, 40)
    assert "have been run" not in as_markdown(outcomes, 1)


def test_a_bar_missed_by_little_is_seen_to_be_missed():
    """Not 98 % beside a bar of 98 %."""
    bar = Bar("95 % intervals that cover the truth", 56 / 57, 0.9, 0.98, 57)
    assert (bar.measured, bar.bar, bar.met) == ("98.2 %", "90 %–98 %", False)


def test_a_share_says_how_well_so_few_cases_know_it():
    """Nine of ten right leaves 60 to 98 % (Wilson), as statsmodels has it; no case leaves no share."""
    right = [outcome("single", ["tether"], "tether")] * 9
    share = bars([*right, outcome("single", ["tether"], "payload")])[0]
    assert share.interval == pytest.approx(proportion_confint(9, 10, method="wilson"), abs=1e-4)
    assert share.measured == "90 % (60–98)"
    assert bars([])[0].measured == "not measured"


def test_times_are_judged_on_two_cores_only():
    """One core is no test of a bar for two; hard cases have one of their own."""
    slow = [
        outcome("single", ["tether"], "tether", seconds=45.0),
        outcome("pair", ["tether", "payload"], seconds=200.0),
    ]
    found = {
        b.what: (b.value, b.met) for b in bars([*slow, *[replace(o, cores=2) for o in slow]]) if b.unit == "s"
    }
    assert found["time of one improve on 1 core (median)"] == (122.5, None)
    assert found["time of one improve on 2 cores (median)"] == (122.5, False)
    hard = "time of one improve on 2 cores, pairs and effects of no catalogue (95th percentile)"
    assert found[hard] == (200.0, False)
    assert found["time of one improve on 2 cores (longest)"] == (200.0, None)


def probable(probability, right, status="explained", kind="single"):
    """The effect ranked first was stated to be so probable."""
    ranked = ("payload",) if right else ("tether",)
    return Outcome(
        f"{probability}-{right}",
        kind,
        ("payload",),
        1.0,
        "white",
        "near",
        status=status,
        ranked=ranked,
        probability=probability,
    )


def test_shares_by_what_was_stated():
    """Nine of ten that were called 97 % probable are right, and one of two that were called 50 %."""
    found = reliability([probable(0.97, n < 9) for n in range(10)] + [probable(0.5, n < 1) for n in range(2)])
    assert [(b.count, b.right) for b in found] == [(2, 1), (10, 9)]
    assert found[1].stated == pytest.approx(0.97)
    assert found[1].interval == pytest.approx(proportion_confint(9, 10, method="wilson"), abs=1e-4)


def test_only_answers_that_accuse_somebody_count():
    """Where nothing is missing no probability was given, and a pair has no single answer."""
    assert (
        reliability([probable(0.9, True, status="nothing_missing"), probable(0.9, True, kind="pair")]) == []
    )
    assert reliability([probable(float("nan"), True)]) == []


def test_certainty_has_a_bin():
    """A probability of one is not lost at the edge."""
    assert reliability([probable(1.0, True)])[0].count == 1


def test_the_page_shows_them():
    """A row for every bin, the stated probability and the share that is right on one line."""
    page = as_markdown([probable(0.5, n < 1) for n in range(4)], 4)
    assert "### Reliability" in page
    row = next(line for line in page.splitlines() if line.startswith("| 40%–60%"))
    assert row.index("●") < row.index("│")
    assert "25% (" in row
