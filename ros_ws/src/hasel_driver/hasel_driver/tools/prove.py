# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 run hasel_driver prove`: breaks the simulated supply's hardware, kind by kind, and judges what the driver says.

The upper and the lower channel are broken by turns. Then other nodes come: a second driver of its name, and strangers.
The truth is the simulated contacts and voltages, never a node's word. With `--firmware` (firmware/build) the sketch in
simavr is tried instead of the virtual supply. The table is printed, and the exit code is 0 where nothing was wrong.
A trial during which this machine itself was late proves nothing, and is repeated.
"""

import argparse
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from itertools import chain, cycle, islice
from pathlib import Path

from hasel_common.command_entry import command

from hasel_driver.protocol.faults import DriverError, RefusedError
from hasel_driver.testing.kinds import CHANNELS, KINDS, UNSEEN, Kind, Trial, try_kind
from hasel_driver.testing.rig import VIRTUAL_SUPPLY, Bench, Punctuality, Rig, firmware_command
from hasel_driver.testing.walk import Walk

ATTEMPTS = 5
DISCOVERY_S = 3.5  # within which a driver that runs already is known


@dataclass(frozen=True)
class ProofRow:
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


class Trials:
    """Tries on supplies started by `command`, each kind `rounds` times."""

    def __init__(self, command: list[str], rounds: int) -> None:
        self._command, self._rounds = command, rounds
        self._punctuality = Punctuality()
        self.repeated = 0

    def of(self, *judges: Callable[[Rig], Trial]) -> list[Trial]:
        """Each on a supply of its own; where there are several judges, they take turns."""
        return [self._one(judge) for judge in islice(cycle(judges), self._rounds)]

    def _one(self, judge: Callable[[Rig], Trial]) -> Trial:
        for attempt in range(ATTEMPTS):
            self.repeated += attempt > 0
            began_s = time.monotonic()
            with closing(Rig(self._command, self._punctuality.note)) as rig:
                try:
                    trial = judge(rig)
                except (AssertionError, DriverError) as failure:
                    trial = Trial(wrong=[str(failure)])
            if not trial.wrong or not self._punctuality.worst_since(began_s):
                break
        return trial


def prove_hardware(trials: Trials, kinds: Sequence[Kind]) -> Iterator[ProofRow]:
    """Each kind, in the upper and the lower channel by turns, with the driver's thread on the supply."""
    for kind in kinds:
        judges = [partial(_try_hardware, kind, channel) for channel in range(len(CHANNELS))]
        yield ProofRow(kind.name, trials.of(*judges), "not before the next arming")


def _try_hardware(kind: Kind, channel: int, rig: Rig) -> Trial:
    with closing(Bench(rig)) as bench:
        return try_kind(bench, kind, channel)


def walk(command: list[str], duration_s: float, seed: int) -> list[str]:
    """A random walk for so long; what was wrong, with all that was done before."""
    late_s: list[float] = []
    with closing(Rig(command, late_s.append)) as rig, closing(Bench(rig)) as bench:
        walk = Walk(bench, seed)
        walk.run(duration_s)
    late = f", the supply late by up to {max(late_s):.2f} s" if late_s else ""
    live = walk.live / walk.looks
    print(
        f"seed {seed}: {len(walk.log)} acts in {duration_s:g} s, {live:.0%} of it live, {len(walk.wrong)} wrong{late}"
    )
    return [*walk.log, *walk.wrong] if walk.wrong else []


def prove_neighbours(trials: Trials) -> Iterator[ProofRow]:
    """Each kind of other node, which a driver on a supply meets. Raises RefusedError where one runs already."""
    from hasel_driver.testing.neighbours import NEIGHBOURS, drivers, meet
    from hasel_driver.testing.ros_client import RosClient

    with closing(RosClient()) as user:
        time.sleep(DISCOVERY_S)
        if drivers(user):
            raise RefusedError(
                "A driver answers to /hasel already: end it first, or set a ROS_DOMAIN_ID of your own."
            )
        for kind in NEIGHBOURS:
            yield ProofRow(kind.name, trials.of(partial(meet, user, kind)), "not obeyed")


@command
def main(arguments: Sequence[str] | None = None) -> int:
    """Command line; 0 where nothing was wrong, else 1."""
    parser = argparse.ArgumentParser(
        prog="prove", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--rounds", type=int, default=5, help="of each kind (default: 5)")
    parser.add_argument(
        "--firmware", type=Path, help="folder with the simulated firmware, from `make simulator`"
    )
    parser.add_argument(
        "--walk", type=float, metavar="SECONDS", help="instead: a random walk over all of it for so long"
    )
    parser.add_argument("--seed", type=int, default=1, help="of the walk (default: 1)")
    options = parser.parse_args(arguments)
    command, kinds = VIRTUAL_SUPPLY, [*KINDS, *UNSEEN]
    if options.firmware is not None:
        command = firmware_command(options.firmware)
        kinds = [kind for kind in kinds if not kind.virtual_only]
    if options.walk:
        wrong = walk(command, options.walk, options.seed)
        print("\n".join(wrong), end="\n" if wrong else "")
        return int(bool(wrong))
    print(f"| kind | found within, of {options.rounds} | wrong |\n|---|---|---|")
    failed, trials = False, Trials(command, options.rounds)
    try:
        for row in chain(prove_hardware(trials, kinds), prove_neighbours(trials)):
            failed |= bool(row.wrong)
            print(row, flush=True)
    except RefusedError as error:
        print(error, file=sys.stderr)
        return 1
    if trials.repeated:
        print(f"{trials.repeated} trials were repeated, as this machine was late.", file=sys.stderr)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
