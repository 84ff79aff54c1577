# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""How often the right effect of a muscle is named: every one hidden in turn, and nothing hidden many times."""

import numpy as np
import pytest
from hasel_muscle.bench_files import read_bench
from hasel_muscle.bench_improvement import BenchVerdict, improve_muscle
from hasel_muscle.bench_problem import BenchProblem
from hasel_muscle.settled import settled
from hasel_sim.model.muscle_file import load_muscle
from hasel_sim.muscle.effect import muscle_catalogue

UNSEEN = {
    "film_elasticity__compliance": 3e-10,
    "series_compliance__compliance": 1e-5,
    "trapped_oil__gap": 5e-6,
}
"""Under one load these are a scale of the force that a free permittivity imitates, or nothing that shows."""
SEEN = [name for name in muscle_catalogue() if not any(key.startswith(name) for key in UNSEEN)]


@pytest.fixture
def found_for(tmp_path):
    """What is found in a bench's lifts, of its own muscle with fill and permittivity off by some per cent."""

    def find(bench):
        bench.noise = 5e-6  # frames of 0.1 s follow a history to less than that
        rng = np.random.default_rng(bench.seed)
        nominal = load_muscle("peano_hasel").values
        bench.muscle = bench.muscle.with_values({n: v * rng.uniform(0.93, 1.07) for n, v in nominal.items()})
        problem = BenchProblem([settled(read_bench(bench.write_csv(tmp_path / f"{bench.seed}.csv")))])
        return improve_muscle(problem, load_muscle("peano_hasel"))

    return find


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(20))
def test_nothing_hidden(bench, found_for, seed):
    """No effect is accused."""
    bench.seed = seed
    assert found_for(bench).status == "nothing_missing"


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("effect", SEEN)
def test_a_hidden_effect_is_named_first_or_within_its_group(bench, found_for, effect, seed):
    """At its typical size; with it the law describes the lifts."""
    bench.seed = seed
    parameters = muscle_catalogue()[effect].parameters
    bench.hiding(**{f"{effect}__{p.name}": p.typical for p in parameters})
    found = found_for(bench)
    assert found.missing
    first = found.stages[2]
    assert effect in (*first.added, *first.rivals)
    assert found.status == "explained"


@pytest.mark.slow
@pytest.mark.parametrize("hidden", UNSEEN)
def test_what_cannot_be_seen_is_said_to_be(bench, found_for, hidden):
    """Hidden, it is not accused, nor is any other; the verdict is that it cannot be seen."""
    found = found_for(bench.hiding(**{hidden: UNSEEN[hidden]}))
    assert found.missing == []
    verdicts = {finding.effect: finding.verdict for finding in found.findings}
    assert verdicts[hidden.partition("__")[0]] is BenchVerdict.UNSEEN
