"""`bench_far`: is a gross constant that is far off named, or put into the stated group?"""

import argparse
import json
import time
from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass

from hasel_sim.parallel import executor
from hasel_sysid.dataset import prepared
from hasel_sysid.improvement import improve
from hasel_sysid.problem import Problem

from hasel_benchmark.bench_far.constants_far_off import BODIES
from hasel_benchmark.bench_far.far_case import FarCase, baseline, far_cases, measure, value_of
from hasel_benchmark.bench_far.options import parser


@dataclass(frozen=True)
class FarOutcome:
    """named: whether the truth is among what was added; grouped: or stated to look like one of that; sure: whether the
    model is said to explain what was seen.
    """

    case: str
    value: float
    missing: tuple[str, ...]
    named: bool
    grouped: bool
    sure: bool
    mae_unseen: float
    seconds: float

    @property
    def right(self) -> bool:
        """Named, or within the stated group."""
        return self.named or self.grouped

    def __str__(self) -> str:
        word = (
            "named"
            if self.named
            else "in the group"
            if self.grouped
            else "WRONG AND SURE"
            if self.sure
            else "missed"
        )
        added = " + ".join(self.missing) or "nothing"
        return (
            f"{self.case}: {word} (added {added}; unseen error {self.mae_unseen:.5f}; {self.seconds:.0f} s)"
        )


def run_case(case: FarCase, pool: Executor, only: Sequence[str] | None = None) -> FarOutcome:
    """What `improve` says of one case. only: names of the candidate effects (default: all)."""
    value = value_of(case)
    fitted, unseen = measure(case, value, pool)
    started = time.monotonic()
    found = improve(
        Problem(fitted, pool),
        prepared(baseline(case.body), fitted),
        Problem(unseen, pool),
        only,
    ).to_json()
    missing, groups = found["verdict"]["missing"], found["indistinguishable"]
    added = found["stages"][-1]["effects"]
    named = case.effect in added
    return FarOutcome(
        case.name,
        value,
        tuple(added),
        named,
        any(case.effect in group and set(added) & set(group) for group in groups),
        found["verdict"]["status"] == "explained" and case.effect not in missing,
        found["stages"][-1]["mae_validation"],
        time.monotonic() - started,
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return run(parser().parse_args(arguments))


def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code."""
    cases = far_cases(options.effects, options.shifts, BODIES if options.body is None else (options.body,))
    outcomes = []
    with executor(options.jobs) as pool:
        for case in cases:
            outcomes.append(run_case(case, pool, options.candidates))
            print(outcomes[-1], flush=True)
    right, sure = sum(o.right for o in outcomes), sum(o.sure and not o.right for o in outcomes)
    print(
        f"{right} of {len(outcomes)} right or in the stated group (bar: 90 %), {sure} wrong and sure (bar: 0)"
    )
    if options.json:
        options.json.write_text(json.dumps([asdict(o) for o in outcomes], indent=1))
    return 0
