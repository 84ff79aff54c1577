# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Run cases, each kept in a file of its own, so that hours of work survive a stop."""

import json
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from hasel_sim.errors import SimulationError
from hasel_sim.model import Model, load_model
from hasel_sim.parallel import SerialExecutor
from hasel_sysid.dataset import prepared
from hasel_sysid.errors import SysidError
from hasel_sysid.experiment import Experiment
from hasel_sysid.improvement import improve
from hasel_sysid.problem import Problem

from hasel_benchmark.bench_hidden.hidden_cases import Case
from hasel_benchmark.bench_hidden.laboratory import Laboratory, measure
from hasel_benchmark.bench_hidden.outcome import Outcome, failed, judge, outcome_from_dict

Explain = Callable[[Laboratory, Executor], dict[str, Any]]
"""What is judged: from measurements to the content of `improve --json`."""


def explain(laboratory: Laboratory, pool: Executor) -> dict[str, Any]:
    """The content of `improve --json` for these measurements, starting from the default swimmer."""
    return answer(load_model("swimmer"), laboratory.fitted, laboratory.unseen, pool)


def answer(
    model: Model,
    fitted: Sequence[Experiment],
    unseen: Sequence[Experiment],
    pool: Executor,
    only: Sequence[str] | None = None,
) -> dict[str, Any]:
    """The content of `improve --json` for these experiments, starting from a model; only: candidate effects."""
    return improve(Problem(fitted, pool), prepared(model, fitted), Problem(unseen, pool), only).to_json()


def outcome_in(file: Path) -> Outcome | None:
    """What an earlier run left about a case."""
    return outcome_from_dict(json.loads(file.read_text())["outcome"]) if file.is_file() else None


def run_case(
    case: Case, explain: Explain, pool: Executor, cores: int = 1
) -> tuple[Outcome, dict[str, Any], dict[str, Any]]:
    """Outcome, hidden values and the answer of one case; a failure to simulate or to explain is an outcome too.

    cores: how many the pool has, for the record.
    """
    try:
        laboratory = measure(case, pool)
    except SimulationError as error:
        return failed(case, f"the truth cannot be simulated: {error}"), {}, {}
    start = time.perf_counter()
    try:
        answer = explain(laboratory, pool)
    except (SysidError, SimulationError) as error:
        return failed(case, f"improve gave up: {error}"), laboratory.values, {}
    outcome = judge(case, laboratory, answer, time.perf_counter() - start)
    return replace(outcome, cores=cores), laboratory.values, answer


def run_cases(
    cases: Sequence[Case],
    explain: Explain,
    pool: Executor,
    folder: Path,
    say: Callable[[str], None],
    at_once: int = 1,
    known: Mapping[str, Outcome] | None = None,
    cores: int = 1,
) -> Iterator[Outcome]:
    """Outcomes of all cases, those already known or in the folder first; each new one is written there at once.

    at_once: how many cases the pool is given at a time, each to one worker; cores: above 1, how many workers the pool
    has, all of which every case has to itself in its turn; known: outcomes by name of the case.
    """
    folder.mkdir(parents=True, exist_ok=True)
    kept = {
        case.name: outcome_in(folder / f"{case.name}.json") or (known or {}).get(case.name) for case in cases
    }
    yield from (outcome for outcome in kept.values() if outcome is not None)
    todo = [case for case in cases if kept[case.name] is None]
    begin = time.perf_counter()
    in_turn = (
        ((case, run_case(case, explain, pool, cores)) for case in todo)
        if cores > 1
        else _beside_each_other(todo, explain, pool, at_once)
    )
    for number, (case, found) in enumerate(in_turn, start=1):
        _keep(case, *found, folder)
        left = (time.perf_counter() - begin) / number * (len(todo) - number)
        say(f"[{number}/{len(todo)}, {_duration(left)} left] {case}: {_in_words(found[0])}")
        yield found[0]


def _beside_each_other(
    cases: Sequence[Case], explain: Explain, pool: Executor, at_once: int
) -> Iterator[tuple[Case, tuple[Outcome, dict[str, Any], dict[str, Any]]]]:
    waiting = list(reversed(cases))
    running: dict[Future[tuple[Outcome, dict[str, Any], dict[str, Any]]], Case] = {}
    while waiting or running:
        while waiting and len(running) < at_once:
            case = waiting.pop()
            running[pool.submit(run_case, case, explain, SerialExecutor())] = case
        finished, _ = wait(running, return_when=FIRST_COMPLETED)
        for future in finished:
            yield running.pop(future), future.result()


def _keep(case: Case, outcome: Outcome, values: dict[str, Any], answer: dict[str, Any], folder: Path) -> None:
    content = {"case": asdict(case), "hidden_values": values, "outcome": asdict(outcome), "answer": answer}
    unfinished = folder / f"{case.name}.part"
    unfinished.write_text(json.dumps(content, indent=1))
    unfinished.replace(folder / f"{case.name}.json")


def _in_words(outcome: Outcome) -> str:
    if outcome.failure:
        return outcome.failure
    added = ", ".join(outcome.missing) or "nothing"
    return f"{outcome.status}, {added} added, first of the ranking {outcome.first or '–'}, {outcome.seconds:.0f} s"


def _duration(seconds: float) -> str:
    minutes = round(seconds / 60)
    return f"{minutes // 60} h {minutes % 60} min" if minutes >= 60 else f"{minutes} min"
