# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""When a muscle's law foretells lifts better than a table of measured strokes does, and when not.

Both are given some of the voltages of a recording and asked for the others: every second one, third one … of them, or
all up to a highest. The table is that of the swimmer's amplitudes, monotone between its voltages and on with its last
slope beyond them; the law has the effects that are named, with everything that is free fitted again each time.

    python law_against_table.py 60g__step….mat parallel_stiffness film_creep
"""

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from hasel_muscle.bench_files import muscle_for, settled_runs
from hasel_muscle.bench_improvement import fit_muscle
from hasel_muscle.bench_problem import BenchProblem, as_muscle
from hasel_muscle.law_check import Rival, rival_table
from hasel_sim.muscle.muscle import Muscle

SETTLING_S = 1.0


def splits(levels: np.ndarray) -> Iterator[tuple[str, np.ndarray]]:
    """What is left for the fit, in words and as voltages [V]: some of all, both ends included, or the lowest."""
    for step in (2, 3, 5):
        kept = np.unique(np.append(levels[::step], levels[-1]))
        yield f"{len(kept)} from {kept[0]:g} to {kept[-1]:g} V", kept
    for share in (0.75, 0.5, 0.375):
        kept = levels[: max(3, round(share * len(levels)))]
        yield f"the {len(kept)} up to {kept[-1]:g} V", kept


def compared(every: BenchProblem, muscle: Muscle, kept: np.ndarray) -> Rival | None:
    """Law and table on the lifts that are left out; None where there is more than one load."""
    apart = [level for level in every.voltages if level not in kept]
    fitted, unseen = every.only_levels(apart, keep=False), every.only_levels(apart)
    return rival_table(fitted, unseen, as_muscle(fit_muscle(fitted, muscle).model))


def main(arguments: list[str]) -> None:
    """Print a line per split."""
    path, *effects = arguments
    every = BenchProblem(settled_runs([Path(path)], SETTLING_S))
    muscle = muscle_for(None, [Path(path)]).with_effects(*effects)
    print("mean error on the voltages left out, mm |   law | table")
    for words, kept in splits(np.asarray(every.voltages)):
        rival = compared(every, muscle, kept)
        if rival is None:
            sys.exit("the recording has several loads, or held lengths: no table of strokes fits it")
        print(f"fitted: {words:31} | {1e3 * rival.law:5.3f} | {1e3 * rival.table:5.3f}")


if __name__ == "__main__":
    main(sys.argv[1:])
