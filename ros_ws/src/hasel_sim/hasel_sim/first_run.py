# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Compile all loops now: `python -m hasel_sim.first_run`, after an installation or a change of them."""

from hasel_sim.bench.cases import box_run, fitted_swimmer
from hasel_sim.simd import LANES
from hasel_sim.simulate import simulate_many


def main() -> None:
    """Simulate with every number of lanes; what is compiled is announced."""
    model, run = fitted_swimmer(), box_run(0.02)
    for count in LANES:
        simulate_many([(model, run)] * count, ("slope",))


if __name__ == "__main__":
    main()
