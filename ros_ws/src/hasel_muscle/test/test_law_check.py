# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Where a law fails, said of muscles whose failure is known."""

from hasel_muscle.bench_files import read_bench
from hasel_muscle.bench_problem import BenchProblem
from hasel_muscle.law_check import where_it_fails
from hasel_muscle.settled import settled
from hasel_sim.model.muscle_file import load_muscle


def said_of(bench, tmp_path) -> str:
    """All sentences about the package's own muscle on this bench's lifts."""
    problem = BenchProblem([settled(read_bench(bench.write_csv(tmp_path / "a.csv")))])
    return " ".join(where_it_fails(problem, load_muscle("peano_hasel")))


def test_the_right_law_fails_nowhere(bench, tmp_path):
    """Nothing is said."""
    assert said_of(bench, tmp_path) == ""


def test_a_stiff_muscle_contracts_less(bench, tmp_path):
    """By how much at the lowest and at the highest voltage."""
    said = said_of(bench.hiding(parallel_stiffness__stiffness=20.0), tmp_path)
    assert "% less at 1500 V" in said and "% less at 5000 V than the law" in said


def test_creep_goes_on_and_stays(bench, tmp_path):
    """While a lift is held, and after release."""
    said = said_of(bench.hiding(film_creep__share=0.2, film_creep__time=5.0), tmp_path)
    assert "per second while a lift is held" in said
    assert "are left after release" in said


def test_retained_charge_tells_polarities_apart(bench, tmp_path):
    """Lifts of one polarity after many of the other are stronger: what is retained adds to them."""
    bench.voltages = (4000.0,) * 5 + (-4000.0,)
    said = said_of(bench.hiding(charge_retention__fraction=0.3, charge_retention__time=20.0), tmp_path)
    assert "at positive voltages than at negative ones" in said
