# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What a person needs of an answer on the terminal: verdict, values, error before and after, doubt, next run."""

from collections.abc import Sequence

from hasel_sysid.answer.diagnosis import Diagnosis, Verdict
from hasel_sysid.answer.next_run import Suggestion
from hasel_sysid.answer.result import Improvement
from hasel_sysid.comparison import Comparison
from hasel_sysid.report.from_improvement import what_is_missing
from hasel_sysid.report.wording import error_text, found_values, value_line


def improvement_lines(
    found: Improvement, comparisons: Sequence[Comparison], suggestions: Sequence[Suggestion]
) -> list[str]:
    """Of an improvement; comparisons: of every stage, the fitted baseline first."""
    lines = [str(found.set_up)] if found.set_up else []
    lines += [_headline(found), *found_values(found)]
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
            lines += [value_line(model.parameters[name]) for name in each.expected]
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
