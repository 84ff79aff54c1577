"""Shares of the time of a forward run, by what is done."""

import cProfile
import pstats

from hasel_sim.bench.cases import box_run
from hasel_sim.model import Model
from hasel_sim.simulate import simulate

KERNELS = {
    ("time_loop.py", "integrate"): "the compiled time loop",
    ("prepared_run.py", "__init__"): "mesh, matrices, drive (prepared once)",
    ("prepared_run.py", "start"): "the state it starts from",
    ("simulate.py", "_observed"): "what the markers see of it",
}
REST = "everything else"


def shares(model: Model) -> list[tuple[str, float]]:
    """What is done and its share of the time, largest first."""
    simulate(model, box_run(0.05))
    profile = cProfile.Profile()
    profile.runcall(simulate, model, box_run())
    rows = pstats.Stats(profile).stats  # type: ignore[attr-defined]
    total = sum(row[2] for row in rows.values())  # 2: time in the function itself, 3: with what it calls
    found = {
        label: sum(
            row[3] for (path, _, name), row in rows.items() if path.endswith(file) and name == function
        )
        for (file, function), label in KERNELS.items()
    }
    found[REST] = total - sum(found.values())
    return sorted(((label, seconds / total) for label, seconds in found.items()), key=lambda pair: -pair[1])
