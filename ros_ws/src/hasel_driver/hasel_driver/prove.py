"""`ros2 run hasel_driver prove`: breaks the simulated supply's hardware, kind by kind, and judges what the driver says.

The truth is the simulated contacts and voltages, never the driver's word. With `--firmware` (firmware/build) the sketch
in simavr is tried instead of the virtual supply. The table is printed, and the exit code is 0 where nothing was wrong.
"""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from hasel_driver.bench_options import firmware_files
from hasel_driver.testing.bench import Bench
from hasel_driver.testing.kinds import KINDS, UNSEEN, Kind, try_kind
from hasel_driver.testing.rig import VIRTUAL_SUPPLY, Rig


def prove(command: list[str], kinds: Sequence[Kind], rounds: int) -> list[tuple[str, float, list[str]]]:
    """For each kind its name, the longest time to its fault [s], and what was wrong."""
    rows = []
    for kind in kinds:
        rig = Rig(command)
        bench = Bench(rig)
        try:
            trials = [try_kind(bench, kind) for _ in range(rounds)]
        finally:
            bench.close()
            rig.close()
        slowest_s = max(
            (trial.found_s for trial in trials if trial.found_s is not None), default=float("nan")
        )
        rows.append((kind.name, slowest_s, [text for trial in trials for text in trial.wrong]))
    return rows


def main(arguments: Sequence[str] | None = None) -> int:
    """Command line; 0 where nothing was wrong, else 1."""
    parser = argparse.ArgumentParser(
        prog="prove", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--rounds", type=int, default=5, help="of each kind (default: 5)")
    parser.add_argument(
        "--firmware", type=Path, help="folder with the simulated firmware, from `make simulator`"
    )
    options = parser.parse_args(arguments)
    command, kinds = VIRTUAL_SUPPLY, [*KINDS, *UNSEEN]
    if options.firmware is not None:
        command = list(map(str, firmware_files(options.firmware)))
        kinds = [kind for kind in kinds if not kind.virtual_only]
    print(f"| kind | found within, of {options.rounds} | wrong |\n|---|---|---|")
    failed = False
    for name, slowest_s, wrong in prove(command, kinds, options.rounds):
        failed |= bool(wrong)
        found = f"{1e3 * slowest_s:.0f} ms" if slowest_s == slowest_s else "not before the next arming"
        print(f"| {name} | {found} | {'; '.join(wrong) or 'nothing'} |", flush=True)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
