# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`bench_hidden`: how often the right hidden effect is named, beside the bars."""

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path

from hasel_sim.parallel import executor, worker_count
from hasel_sysid.command_line.running import PACKAGES as IDENTIFYING

from hasel_benchmark.bench_hidden.hidden_cases import Case, list_cases, quick_cases
from hasel_benchmark.bench_hidden.outcome import Outcome
from hasel_benchmark.bench_hidden.paired import group_sizes, paired, times
from hasel_benchmark.bench_hidden.results_page import as_json, as_markdown, outcomes_of
from hasel_benchmark.bench_hidden.run_cases import explain, outcome_in, run_cases
from hasel_benchmark.benchmark_commands import KINDS, PAGE
from hasel_benchmark.errors import BenchmarkError

PACKAGES = (*IDENTIFYING, "hasel_bringup", "hasel_benchmark")


def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code.

    Raises BenchmarkError where they cannot be followed, ModelError or SimulationError where nothing can be simulated.
    """
    cases = _cases(options)
    if not cases:
        raise BenchmarkError("No case is left to run; choose other --effects or another kind with --only.")
    if options.alone and options.scheduler:
        raise BenchmarkError("--alone measures times on this machine; leave out --scheduler.")
    if not options.resume and any(options.output.glob("*.json")):
        raise BenchmarkError(
            f"{options.output} already holds results; go on with --resume, or name another folder with --output."
        )
    before = _outcomes_at(options.against) if options.against else {}
    page = options.page or _default_page(options)
    known = _told_on(page.with_suffix(".json")) if options.resume else {}
    outcomes: list[Outcome] = []
    stopped = False
    try:
        with executor(options.jobs, options.scheduler, PACKAGES) as pool:
            at_once = len(cases) if options.scheduler else worker_count(options.jobs)
            cores = worker_count(options.jobs) if options.alone else 1
            for outcome in run_cases(cases, explain, pool, options.output, _say, at_once, known, cores):
                outcomes.append(outcome)
    except KeyboardInterrupt:
        stopped = True
        _say(f"Stopped after {len(outcomes)} of {len(cases)} cases; go on with --resume.")
    _write(outcomes, len(cases), page)
    if before:
        figures = (group_sizes(before, outcomes), times(before, outcomes))
        print("\n".join([*map(str, paired(before, outcomes)), *figures]))
    return 130 if stopped else 0


def _outcomes_at(path: Path) -> dict[str, Outcome]:
    """Of an earlier run, by the name of their case. Raises BenchmarkError where there are none."""
    if path.is_dir():
        found = [outcome_in(file) for file in path.glob("**/*.json")]
        known = {outcome.case: outcome for outcome in found if outcome is not None}
    else:
        known = _told_on(path)
    if not known:
        raise BenchmarkError(
            f"{path} holds no outcomes; expected an output folder of bench_hidden, or the JSON beside its page."
        )
    return known


def _told_on(path: Path) -> dict[str, Outcome]:
    """What a page already tells, from the JSON beside it."""
    return outcomes_of(json.loads(path.read_text())) if path.is_file() else {}


def _cases(options: argparse.Namespace) -> list[Case]:
    if options.quick:
        return quick_cases(options.truth)
    kinds = list(KINDS.values()) if options.only is None else [KINDS[options.only]]
    effects = [name for name in options.effects.split(",") if name]
    seeds = range(options.first_seed, options.first_seed + options.seeds)
    return list_cases(kinds, seeds, effects, options.truth)


def _default_page(options: argparse.Namespace) -> Path:
    part = options.quick or options.only or options.effects or options.first_seed
    return options.output / PAGE.name if part else PAGE


def _write(outcomes: Sequence[Outcome], planned: int, page: Path) -> None:
    if not outcomes:
        return
    page.parent.mkdir(parents=True, exist_ok=True)
    text = as_markdown(outcomes, planned)
    page.write_text(text)
    page.with_suffix(".json").write_text(json.dumps(as_json(outcomes)))
    print(text)
    _say(f"Written to {page} and {page.with_suffix('.json')}.")


def _say(sentence: str) -> None:
    print(sentence, file=sys.stderr, flush=True)
