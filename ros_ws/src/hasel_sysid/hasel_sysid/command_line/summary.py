"""What a person needs of an answer on the terminal: verdict, values, error before and after, doubt, next run."""

import math
from collections.abc import Sequence

from hasel_sim.model import Parameter

from hasel_sysid.compare import Comparison
from hasel_sysid.diagnosis import Diagnosis, Verdict
from hasel_sysid.report.from_improvement import what_is_missing
from hasel_sysid.report.numbers import error_text, interval_text
from hasel_sysid.result import Improvement
from hasel_sysid.suggest import Suggestion

_ON_BOUND = 1e-6
"""Share of a parameter's range; a fit comes so near a bound that it wants to go beyond."""


def improvement_lines(
    found: Improvement, comparisons: Sequence[Comparison], suggestions: Sequence[Suggestion]
) -> list[str]:
    """Of an improvement; comparisons: of every stage, the fitted baseline first."""
    lines = [str(found.set_up)] if found.set_up else []
    lines += [_headline(found), *_values(found, comparisons[-1])]
    lines += _errors(comparisons[0], comparisons[-1], found.noise_floor)
    if not found.constant:
        lines += [*_doubt(found.diagnosis, found.missing), found.reason]
    lines += [*found.contradictions, *found.open_values.values()]
    if found.goodness is not None and not found.goodness.adequate:
        lines.append(str(found.goodness))
    if suggestions:
        lines.append(f"Measure next: {suggestions[0]}")
    return lines


def diagnosis_lines(found: Diagnosis, comparison: Comparison) -> list[str]:
    """Of a diagnosis of the fitted model that `comparison` shows."""
    named = [each for each in found.findings if each.verdict is Verdict.MISSING]
    lines = [str(each) for each in named] or ["No effect stands out as missing."]
    for each in named:
        if each.fit is not None:
            model = each.fit.model
            lines += [_interval(model.parameters[name]) for name in each.expected]
    lines += _errors(None, comparison, found.measured.mean_absolute)
    doubt = _doubt(found, [each.effect for each in named])
    lines += doubt
    if found.goodness is not None:
        lines.append(str(found.goodness))
    if found.not_tried:
        lines.append(f"The time was over; not tried: {', '.join(found.not_tried)}.")
    if doubt:
        lines.append("Next: `suggest` proposes the run that tells these apart.")
    elif named:
        lines.append("Next: `improve` adds it and judges it on runs left out.")
    return lines


def _headline(found: Improvement) -> str:
    if found.constant:
        return found.reason
    return what_is_missing(found) or f"{found.status.value.replace('_', ' ').capitalize()}."


def _values(found: Improvement, last: Comparison) -> list[str]:
    names = [name for name in last.model.parameters if name.rpartition(".")[0] in found.missing]
    names += [found.constant.name] if found.constant else []
    return [_interval(last.model.parameters[name]) for name in names]


def _interval(parameter: Parameter) -> str:
    span = parameter.upper - parameter.lower
    for which, bound in (("lower", parameter.lower), ("upper", parameter.upper)):
        if abs(parameter.value - bound) < _ON_BOUND * span < math.inf:
            unit = "" if parameter.unit == "1" else f" {parameter.unit}"
            return f"  {parameter.name} is on its {which} bound, {bound:g}{unit}"
    return f"  {parameter.name} = {interval_text(parameter.value, parameter.standard_error, parameter.unit)}"


def _errors(before: Comparison | None, after: Comparison, noise: float) -> list[str]:
    lines = []
    for name, attribute in (
        ("fitted runs", "mean_absolute_error"),
        ("unseen runs", "mean_absolute_error_unseen"),
    ):
        now = getattr(after, attribute)
        if now is None:
            continue
        then = None if before is None or before is after else getattr(before, attribute)
        fallen = error_text(now) if then is None else f"{error_text(then)} before, {error_text(now)} after"
        lines.append(f"  mean |Δ sin θ| on {name}: {fallen}")
    return [*lines, f"  noise floor: {error_text(noise)}"]


def _doubt(found: Diagnosis, named: Sequence[str]) -> list[str]:
    return [
        f"  These recordings cannot tell apart: {', '.join(group)}."
        for group in found.groups_in_question
        if not named or set(group) & set(named)
    ]
