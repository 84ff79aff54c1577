# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A fit against the likelihood of the truth."""

import pytest
from hasel_benchmark import benchmark_commands
from hasel_benchmark.bench_fits import FitOutcome, effects_with_coordinates, fit_case
from hasel_sim.parallel import executor


@pytest.mark.slow
def test_a_tether_is_found_from_its_starts_and_from_its_true_values():
    """As likely as the truth, and at its place."""
    with executor(1) as pool:
        found = fit_case("tether", 0.2, 0, pool)
    assert found.both_reach_it
    assert found.from_starts == pytest.approx(found.hidden, rel=0.1)


def test_a_fit_that_ends_in_another_valley_is_missed():
    """However well the other one does."""
    values = {"tether.stiffness": 5.0, "tether.position": 0.1}
    outcome = FitOutcome("tether", 0.05, values, values, values, 40.0, -1.0)
    assert not outcome.both_reach_it
    assert str(outcome).startswith("MISSED tether at 5% of its range: stiffness 5, position 0.1;")


def test_an_effect_without_place_and_time_is_told_so(capsys):
    """With the nearest one that has some."""
    assert "tether" in effects_with_coordinates() and "payload" not in effects_with_coordinates()
    assert benchmark_commands.bench_fits(["--effects", "payload"]) == 1
    assert capsys.readouterr().err.startswith("error: 'payload' has neither place nor time; ")
