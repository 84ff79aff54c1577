"""Stated probabilities beside how often they are right."""

import pytest
from hasel_benchmark.bench_hidden.outcome import Outcome
from hasel_benchmark.bench_hidden.page import as_markdown
from hasel_benchmark.bench_hidden.reliability import reliability
from statsmodels.stats.proportion import proportion_confint


def outcome(probability, right, status="explained", kind="single"):
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
    found = reliability([outcome(0.97, n < 9) for n in range(10)] + [outcome(0.5, n < 1) for n in range(2)])
    assert [(b.count, b.right) for b in found] == [(2, 1), (10, 9)]
    assert found[1].stated == pytest.approx(0.97)
    assert found[1].interval == pytest.approx(proportion_confint(9, 10, method="wilson"), abs=1e-4)


def test_only_answers_that_accuse_somebody_count():
    """Where nothing is missing no probability was given, and a pair has no single answer."""
    assert reliability([outcome(0.9, True, status="nothing_missing"), outcome(0.9, True, kind="pair")]) == []
    assert reliability([outcome(float("nan"), True)]) == []


def test_certainty_has_a_bin():
    """A probability of one is not lost at the edge."""
    assert reliability([outcome(1.0, True)])[0].count == 1


def test_the_page_shows_them():
    """A row for every bin, the stated probability and the share that is right on one line."""
    page = as_markdown([outcome(0.5, n < 1) for n in range(4)], 4)
    assert "### Reliability" in page
    row = next(line for line in page.splitlines() if line.startswith("| 40%–60%"))
    assert row.index("●") < row.index("│")
    assert "25% (" in row
