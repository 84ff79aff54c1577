"""`ros2 run hasel_driver prove`: breaks the simulated supply's hardware, kind by kind, and judges what the driver says.

Then other nodes come: a second driver of its name, and strangers. The truth is the simulated contacts and voltages,
never a node's word. With `--firmware` (firmware/build) the sketch in simavr is tried instead of the virtual supply.
The table is printed, and the exit code is 0 where nothing was wrong.
"""

import argparse
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from hasel_driver.bench_options import firmware_files
from hasel_driver.errors import RefusedError
from hasel_driver.testing.bench import Bench
from hasel_driver.testing.kinds import KINDS, UNSEEN, Kind, Trial, try_kind
from hasel_driver.testing.rig import VIRTUAL_SUPPLY, Rig

DISCOVERY_S = 3.5  # within which a driver that runs already is known


@dataclass(frozen=True)
class Row:
    """What became of a kind, all rounds together; `otherwise`: what is expected of one that need not be found."""

    name: str
    trials: Sequence[Trial]
    otherwise: str

    @property
    def wrong(self) -> list[str]:
        """Sentences."""
        return [text for trial in self.trials for text in trial.wrong]

    def __str__(self) -> str:
        times_s = [trial.found_s for trial in self.trials if trial.found_s is not None]
        found = f"{1e3 * max(times_s):.0f} ms" if times_s else self.otherwise
        return f"| {self.name} | {found} | {'; '.join(self.wrong) or 'nothing'} |"


def prove_hardware(command: list[str], kinds: Sequence[Kind], rounds: int) -> Iterator[Row]:
    """Each kind on a supply of its own, started by `command`, with the driver's thread on it."""
    for kind in kinds:
        rig = Rig(command)
        bench = Bench(rig)
        try:
            trials = [try_kind(bench, kind) for _ in range(rounds)]
        finally:
            bench.close()
            rig.close()
        yield Row(kind.name, trials, "not before the next arming")


def prove_neighbours(command: list[str], rounds: int) -> Iterator[Row]:
    """Each kind of other node, which a driver on a supply meets. Raises RefusedError where one runs already."""
    from hasel_driver.testing.neighbours import NEIGHBOURS, drivers, meet
    from hasel_driver.testing.ros_client import RosClient

    user = RosClient()
    try:
        time.sleep(DISCOVERY_S)
        if drivers(user):
            raise RefusedError(
                "A driver answers to /hasel already: end it first, or set a ROS_DOMAIN_ID of your own."
            )
        for kind in NEIGHBOURS:
            rig = Rig(command)
            try:
                trials = [meet(rig, user, kind) for _ in range(rounds)]
            finally:
                rig.close()
            yield Row(kind.name, trials, "not obeyed")
    finally:
        user.close()


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
    try:
        for prove in (
            prove_hardware(command, kinds, options.rounds),
            prove_neighbours(command, options.rounds),
        ):
            for row in prove:
                failed |= bool(row.wrong)
                print(row, flush=True)
    except RefusedError as error:
        print(error, file=sys.stderr)
        return 1
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
