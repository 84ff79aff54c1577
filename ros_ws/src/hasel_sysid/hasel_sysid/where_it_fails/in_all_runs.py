"""What goes wrong alike in many runs, and in which of them more."""

from collections.abc import Sequence

import numpy as np

from hasel_sysid.where_it_fails.component import Component, Kind
from hasel_sysid.where_it_fails.failure import Failure
from hasel_sysid.where_it_fails.pooled import pool, trend
from hasel_sysid.where_it_fails.run_series import RunSeries
from hasel_sysid.where_it_fails.sentences import words

_CLEAR = 3.0
ALL_RUNS = "all runs"


def failures_in_all_runs(
    runs: Sequence[RunSeries], components: Sequence[Sequence[Component]], noise: float
) -> list[Failure]:
    """Components that are clear over all runs, or clear in one condition, largest first.

    components: of each run; noise: rms of sin theta below which nothing is reported.
    """
    found = []
    for kind in Kind:
        pairs = [
            (run, c) for run, parts in zip(runs, components, strict=True) for c in parts if c.kind is kind
        ]
        if len(pairs) > 1:
            failure = _failure(kind, [p[0] for p in pairs], [p[1] for p in pairs], noise)
            found += [] if failure is None else [failure]
    return sorted(found, key=lambda failure: -failure.size)


def _failure(kind: Kind, runs: list[RunSeries], parts: list[Component], noise: float) -> Failure | None:
    size = float(np.sqrt(np.mean([c.size**2 for c in parts])))
    if size < noise:
        return None
    values, errors = [c.value for c in parts], [c.standard_error for c in parts]
    whole = pool(values, errors)
    remarks = _conditions(runs, values, errors)
    if _disagree(values, errors):
        return None if kind is Kind.RINGING else _opposed(runs, parts)
    if abs(whole.mean) < _CLEAR * whole.standard_error and not remarks:
        return None
    if kind is Kind.OFFSET and whole.scatter > whole.standard_error:
        remarks.append("not alike in all runs as that of a camera or a marker would be")
    details = [c.detail for c in parts if c.detail]
    detail = {name: float(np.median([d[name] for d in details])) for name in details[0]} if details else None
    component = Component(kind, whole.mean, whole.standard_error, parts[0].unit, size, detail)
    return Failure(component, ALL_RUNS, ", ".join(remarks))


def _conditions(runs: list[RunSeries], values: list[float], errors: list[float]) -> list[str]:
    """At which frequency and which level of the drive the value stands out."""
    frequencies = [float(f"{run.frequency:.2g}") for run in runs]
    levels = [float(f"{run.level:.4g}") for run in runs]
    labels = dict(zip(levels, (run.level_text for run in runs), strict=True))
    frequency, level = trend(frequencies, values, errors), trend(levels, values, errors)
    found = [] if frequency is None or frequency.condition == 0 else [f"more at {frequency.condition:g} Hz"]
    return found + ([] if level is None or level.condition == 0 else [f"more at {labels[level.condition]}"])


def _disagree(values: list[float], errors: list[float]) -> bool:
    """Whether clear values of both signs occur, the rarer sign in more than a fifth of the clear runs."""
    clear = [value > 0 for value, error in zip(values, errors, strict=True) if abs(value) > _CLEAR * error]
    return len(clear) > 0 and 0.2 < sum(clear) / len(clear) < 0.8


def _opposed(runs: list[RunSeries], parts: list[Component]) -> Failure:
    """The run with the largest size, and the one that goes furthest the other way."""
    largest = max(range(len(parts)), key=lambda n: parts[n].size)
    sign = np.sign(parts[largest].value)
    other = min(range(len(parts)), key=lambda n: sign * parts[n].value)
    return Failure(parts[largest], runs[largest].name, f"but {words(parts[other])} in {runs[other].name}")
