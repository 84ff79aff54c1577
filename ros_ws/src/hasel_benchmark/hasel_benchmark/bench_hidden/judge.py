"""Set the JSON of `improve` against the truth of its case."""

from math import nan

from hasel_sim.effects.registry import catalogue

from hasel_benchmark.bench_hidden.case import Case
from hasel_benchmark.bench_hidden.generate import Laboratory
from hasel_benchmark.bench_hidden.outcome import Estimate, Outcome


def judge(case: Case, laboratory: Laboratory, answer: dict, seconds: float) -> Outcome:
    """answer: what `improve --json` writes; seconds: how long it took."""
    stages, verdict = answer["stages"], answer["verdict"]
    return Outcome(
        case=case.name,
        kind=case.kind,
        hidden=case.effects,
        size=case.size,
        colour=case.colour,
        numerics=case.numerics,
        status=verdict["status"],
        missing=tuple(verdict["missing"]),
        ranked=tuple(entry["effect"] for entry in answer["ranking"]),
        groups=tuple(tuple(group) for group in answer["indistinguishable"]),
        mae_fitted=(stages[0]["mae_fit"], stages[-1]["mae_fit"]),
        mae_unseen=(stages[0]["mae_validation"], stages[-1]["mae_validation"]),
        floor_fitted=laboratory.floor_fitted,
        floor_unseen=laboratory.floor_unseen,
        estimates=_estimates(laboratory.values, stages[-1]["parameters"]),
        seconds=seconds,
        fault=case.fault,
        set_up=verdict.get("set_up") or "",
        probability=float(answer["ranking"][0].get("probability", nan)) if answer["ranking"] else nan,
    )


def failed(case: Case, failure: str) -> Outcome:
    """The outcome of a case without an answer."""
    return Outcome(
        case.name,
        case.kind,
        case.effects,
        case.size,
        case.colour,
        case.numerics,
        failure=failure,
        fault=case.fault,
    )


def _estimates(values: dict[str, dict[str, float]], fitted: dict[str, dict]) -> tuple[Estimate, ...]:
    """Parameters that have a value without effect; one that has none (a relaxation time) says nothing of its size."""
    own = [
        (f"{identity}.{p.name}", values[identity][p.name])
        for identity in values
        if identity in catalogue()
        for p in catalogue()[identity].parameters
        if not p.scan
    ]
    return tuple(
        Estimate(name, fitted[name]["value"], fitted[name].get("std"), truth)
        for name, truth in own
        if name in fitted
    )
