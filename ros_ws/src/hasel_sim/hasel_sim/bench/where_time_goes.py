"""Shares of the time of a forward run, by what is done."""

import cProfile
import pstats

from hasel_sim.bench.cases import box_run
from hasel_sim.model import Model
from hasel_sim.simulate import simulate

KERNELS = {
    ("banded_lu.py", "factorise"): "factorise the band matrix",
    ("banded_lu.py", "solve"): "solve with the factors",
    ("newton.py", "_assembled"): "assemble the matrix",
    ("newton.py", "_derived"): "material moduli",
    ("newton.py", "_stressed"): "motion, strains and stresses",
    ("newton.py", "_out_of_balance"): "nodal and inertia forces",
}
REST = "everything else (Python, array copies)"


def shares(model: Model) -> list[tuple[str, float]]:
    """What is done and its share of the time, largest first."""
    simulate(model, box_run(0.05))
    profile = cProfile.Profile()
    profile.runcall(simulate, model, box_run())
    rows = pstats.Stats(profile).stats  # type: ignore[attr-defined]
    total = sum(row[2] for row in rows.values())
    found = {
        label: sum(
            row[2] for (path, _, name), row in rows.items() if path.endswith(file) and name == function
        )
        for (file, function), label in KERNELS.items()
    }
    found[REST] = total - sum(found.values())
    return sorted(((label, seconds / total) for label, seconds in found.items()), key=lambda pair: -pair[1])
