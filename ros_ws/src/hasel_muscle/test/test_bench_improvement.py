# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Which effect a made-up muscle hides: named, sized, foretold; and nothing where nothing is hidden."""

import numpy as np
import pytest
from hasel_muscle.bench_files import read_bench, settled_runs
from hasel_muscle.bench_improvement import BenchVerdict, fit_muscle, improve_muscle
from hasel_muscle.bench_problem import BenchProblem
from hasel_muscle.bench_report import sentences
from hasel_muscle.law_check import rival_table
from hasel_muscle.settled import settled
from hasel_sim.model.muscle_file import load_muscle
from hasel_sysid.errors import SysidError
from numpy.testing import assert_allclose

FEW = ("parallel_stiffness", "film_creep", "trapped_oil", "series_compliance")


@pytest.fixture
def problem_of(tmp_path):
    """The problem of a bench's lifts."""

    def make(bench):
        return BenchProblem([settled(read_bench(bench.write_csv(tmp_path / f"{bench.seed}.csv")))])

    return make


def test_constants_are_found_with_intervals_that_hold(bench, problem_of):
    """Fill and permittivity come out within three standard errors of the truth, and these are small."""
    bench.muscle = bench.muscle.with_values({"pouch.fill": 0.85, "pouch.relative_permittivity": 2.9})
    fitted = fit_muscle(problem_of(bench), load_muscle("peano_hasel")).model
    for name, truth in (("pouch.fill", 0.85), ("pouch.relative_permittivity", 2.9)):
        p = fitted.parameters[name]
        assert 0 < p.standard_error < 0.01
        assert abs(p.value - truth) < 3 * p.standard_error


def test_nothing_hidden_is_nothing_missing(bench, problem_of):
    """The fitted law describes the lifts; no effect is accused."""
    found = improve_muscle(problem_of(bench), load_muscle("peano_hasel"), candidates=FEW)
    assert (found.status, found.missing) == ("nothing_missing", [])
    assert {finding.verdict for finding in found.findings} <= {BenchVerdict.ABSENT, BenchVerdict.UNSEEN}


@pytest.mark.parametrize(
    ("effect", "name", "value"),
    [("parallel_stiffness", "stiffness", 6.0), ("film_creep", "share", 0.08)],
)
def test_a_hidden_effect_is_named_and_sized(bench, problem_of, effect, name, value):
    """It is added first, at its size, unseen voltages fall to the noise, and the table of strokes is beaten."""
    extra = {"film_creep__time": 10.0} if effect == "film_creep" else {}
    every = problem_of(bench.hiding(**{f"{effect}__{name}": value}, **extra))
    apart = [2500.0, 4500.0]
    fitted, unseen = every.only_levels(apart, keep=False), every.only_levels(apart)
    found = improve_muscle(fitted, load_muscle("peano_hasel"), unseen, FEW)
    assert found.missing[0] == effect
    assert found.status == "explained"
    assert_allclose(found.muscle.values[f"{effect}.{name}"], value, rtol=0.05)
    assert found.stages[-1].unseen["m"] < 3e-6 < 0.1 * found.stages[1].unseen["m"]
    rival = rival_table(fitted, unseen, found.muscle)
    assert rival.law < 0.2 * rival.table


def test_what_a_free_constant_imitates_is_not_called_absent(bench, problem_of):
    """A layer of oil is a film of another permittivity: hidden, it is neither named nor excluded."""
    problem = problem_of(bench.hiding(trapped_oil__gap=5e-6))
    found = improve_muscle(problem, load_muscle("peano_hasel"), candidates=["trapped_oil"])
    assert found.status == "nothing_missing"
    assert [finding.verdict for finding in found.findings] == [BenchVerdict.UNSEEN]


def test_the_limit_of_what_is_absent_is_one(bench, problem_of):
    """A stiffness that is absent is at most some hundredths of a newton, and the limit is not nothing."""
    found = improve_muscle(problem_of(bench), load_muscle("peano_hasel"), candidates=["parallel_stiffness"])
    (finding,) = found.findings
    assert finding.verdict is BenchVerdict.ABSENT
    limit = float(finding.reason.split("parallel_stiffness.stiffness ")[1].split()[0])
    assert 1e-5 < limit < 0.05


def test_what_a_hanging_load_cannot_show_is_said(bench, problem_of):
    """A spring in series never moves under one load: cannot be seen."""
    found = improve_muscle(problem_of(bench), load_muscle("peano_hasel"), candidates=["series_compliance"])
    (finding,) = found.findings
    assert finding.verdict is BenchVerdict.UNSEEN


def test_held_lengths_show_it(bench, tmp_path):
    """Forces at two held contractions tell the spring in series."""
    bench.hiding(series_compliance__compliance=5e-4)
    paths = [bench.write_force_csv(tmp_path / f"{x}.csv", 1e-3 * x) for x in (2, 6)]
    problem = BenchProblem(settled_runs(paths, 1.0))
    found = improve_muscle(problem, load_muscle("peano_hasel"), candidates=["series_compliance"])
    assert found.missing == ["series_compliance"]
    assert_allclose(found.muscle.values["series_compliance.compliance"], 5e-4, rtol=0.1)


def test_a_stranger_leaves_the_others_unjudged(bench, tmp_path):
    """Where no candidate explains the lifts, none is called absent."""
    time, voltage, x = bench.samples()
    odd = x * (1 + 0.3 * np.sin(voltage / 300.0))
    rows = "\n".join(f"{t:.2f},{v:.1f},{1e3 * c:.6f}" for t, v, c in zip(time, voltage, odd, strict=True))
    (tmp_path / "odd.csv").write_text(f"#load_n: 0.5\ntime_s,voltage_v,contraction_mm\n{rows}\n")
    problem = BenchProblem([settled(read_bench(tmp_path / "odd.csv"))])
    found = improve_muscle(problem, load_muscle("peano_hasel"), candidates=FEW)
    assert found.status in ("unexplained", "partly_explained")
    assert BenchVerdict.ABSENT not in {finding.verdict for finding in found.findings}


def test_a_size_beyond_its_range_explains_no_more_than_a_part(bench, problem_of):
    """A stiffness of three times what is plausible ends at its bound, and that is said."""
    problem = problem_of(bench.hiding(parallel_stiffness__stiffness=600.0))
    found = improve_muscle(problem, load_muscle("peano_hasel"), candidates=["parallel_stiffness"])
    assert found.status == "partly_explained"
    assert "parallel_stiffness.stiffness would leave its plausible range" in " ".join(sentences(found))


def test_a_value_on_the_edge_of_its_range_comes_after_one_inside(bench, problem_of):
    """Charge that is retained at once only weakens the voltage, as narrower electrodes do: those are named first."""
    problem = problem_of(bench.hiding(trapped_oil__gap=3e-5))
    both = ["charge_retention", "edge_effect"]
    found = improve_muscle(problem, load_muscle("peano_hasel"), candidates=both)
    assert found.missing == ["edge_effect"]
    assert found.stages[-1].rivals == ("charge_retention",)
    assert [finding.verdict for finding in found.findings] == [BenchVerdict.MISSING, BenchVerdict.AS_GOOD]


def test_too_few_voltages_are_refused(bench, problem_of):
    """Four voltages cannot tell an effect from chance."""
    bench.voltages = (2000.0, 3000.0, 4000.0, 5000.0)
    with pytest.raises(SysidError, match="lift at 4 voltages; expected 5"):
        improve_muscle(problem_of(bench), load_muscle("peano_hasel"))


def test_lifts_alike_tell_how_well_they_repeat(bench, tmp_path):
    """Three lifts at one voltage scatter by what they differ."""
    bench.voltages = (3000.0, -3000.0, 3000.0)
    time, voltage, x = bench.samples()
    number = np.floor((time - 2.0) / 7.0)
    x = x + np.where(voltage != 0, (number - 1) * 1e-4, 0.0)
    rows = "\n".join(f"{t:.2f},{v:.1f},{1e3 * c:.6f}" for t, v, c in zip(time, voltage, x, strict=True))
    (tmp_path / "a.csv").write_text(f"#load_n: 0.5\ntime_s,voltage_v,contraction_mm\n{rows}\n")
    problem = BenchProblem([settled(read_bench(tmp_path / "a.csv"))])
    assert_allclose(problem.repeatability * problem.scales["m"], 1e-4, rtol=0.02)
