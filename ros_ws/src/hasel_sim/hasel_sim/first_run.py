"""`python -m hasel_sim.first_run`: compile the loops now, so that nothing that is timed has to."""

from hasel_sim.bench.cases import box_run, fitted_swimmer
from hasel_sim.simd import LANES
from hasel_sim.simulate import simulate_many


def main() -> None:
    """Simulate with every number of lanes."""
    model, run = fitted_swimmer(), box_run(0.02)
    for count in LANES:
        simulate_many([(model, run)] * count, ("slope",))


if __name__ == "__main__":
    main()
