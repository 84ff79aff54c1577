"""`bench_fits`: every effect that has a place or a time, at five sizes over its range."""

import argparse
import json
from dataclasses import asdict

from hasel_common.names import nearest_name
from hasel_sim.parallel import executor

from hasel_benchmark.bench_fits.fit_case import SHARES, effects_with_coordinates, fit_case
from hasel_benchmark.errors import BenchmarkError


def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code.

    Raises BenchmarkError for an effect that has neither place nor time.
    """
    every = effects_with_coordinates()
    for name in options.effects or ():
        if name not in every:
            raise BenchmarkError(f"'{name}' has neither place nor time; {nearest_name(name, every)}.")
    outcomes = []
    with executor(options.jobs) as pool:
        for effect in options.effects or every:
            for share in SHARES:
                outcomes.append(fit_case(effect, share, options.seed, pool))
                print(outcomes[-1], flush=True)
    reached = sum(outcome.both_reach_it for outcome in outcomes)
    print(
        f"{reached} of {len(outcomes)} fits end as likely as the truth from both starts ({reached / len(outcomes):.0%};"
        " bar: 98 %)"
    )
    if options.json:
        options.json.write_text(json.dumps([asdict(outcome) for outcome in outcomes], indent=1))
    return 0
