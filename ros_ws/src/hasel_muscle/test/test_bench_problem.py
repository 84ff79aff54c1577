# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Settled lifts as a problem of the common search."""

import numpy as np
import pytest
from hasel_muscle.bench_files import read_bench
from hasel_muscle.bench_problem import BenchProblem, as_model
from hasel_muscle.settled import settled
from hasel_sim.model.muscle_file import load_muscle
from hasel_sysid.errors import SysidError
from hasel_sysid.problem import LowFidelityProblem
from numpy.testing import assert_allclose

NAMES = ("pouch.fill", "parallel_stiffness.stiffness")


@pytest.fixture
def problem(bench, tmp_path) -> BenchProblem:
    """Lifts of a muscle with a stiffness."""
    bench.hiding(parallel_stiffness__stiffness=6.0)
    return BenchProblem([settled(read_bench(bench.write_csv(tmp_path / "a.csv")))])


@pytest.fixture
def muscle():
    """One that is a little softer."""
    soft = load_muscle("peano_hasel").with_effects("parallel_stiffness")
    return soft.with_values({"parallel_stiffness.stiffness": 5.0})


def test_the_lifts_of_one_voltage_are_a_run(problem, muscle):
    """With all counting frames, no mean removed."""
    found = problem.evaluate(as_model(muscle))
    assert len(problem.experiments) == 1 + len(problem.voltages)
    assert found.residual @ found.residual == pytest.approx(
        np.sum(((problem.predicted(muscle) - problem.measured) / problem.scales["m"]) ** 2)
    )
    assert_allclose(np.sort(found.measured()), np.sort(problem.measured) / problem.scales["m"])


def test_derivatives_say_what_a_small_change_does(problem, muscle):
    """Also at a bound, where only one side is there."""
    for stiffness in (0.0, 5.0):
        here = muscle.with_values({NAMES[1]: stiffness})
        begun = problem.evaluate(as_model(here), NAMES)
        change = {NAMES[0]: 1e-4, NAMES[1]: 1e-2}
        moved = here.with_values({name: here.values[name] + by for name, by in change.items()})
        predicted = begun.jacobian @ list(change.values())
        seen = begun.residual - problem.evaluate(as_model(moved)).residual
        assert np.linalg.norm(seen - predicted) < 0.02 * np.linalg.norm(seen)


def test_some_of_the_runs_are_as_in_all_of_them(problem, muscle):
    """In the order in which they are asked for, and by a low-fidelity model that is the model."""
    whole = problem.evaluate(as_model(muscle), NAMES)
    few = LowFidelityProblem(problem, whole).of_runs([4, 2])
    found = few.evaluate(as_model(muscle), NAMES)
    assert_allclose(found.residual, whole.of_runs([4, 2]).residual)
    assert_allclose(found.jacobian, whole.of_runs([4, 2]).jacobian)


def test_a_recording_that_does_not_tell_its_noise_is_refused(bench, tmp_path):
    """One hold of a few frames: the sentence says what to record."""
    rows = "\n".join(f"{0.5 * n:.1f},{3000.0 * (n > 1):.0f},{float(n > 1):.3f}" for n in range(6))
    (tmp_path / "a.csv").write_text(f"#load_n: 0.5\ntime_s,voltage_v,contraction_mm\n{rows}\n")
    with pytest.raises(SysidError, match=r"does not tell the noise of a settled frame.*rest of a second"):
        _ = BenchProblem([settled(read_bench(tmp_path / "a.csv"))]).measured_noise
