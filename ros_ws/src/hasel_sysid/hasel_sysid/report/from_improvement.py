# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The report's content from a diagnosis or an improvement: what was missing, what remains, what to measure next."""

from collections.abc import Sequence
from dataclasses import replace

from hasel_sim.effects.base import Effect
from hasel_sim.effects.registry import catalogue, find_effects
from hasel_sim.errors import ModelError
from hasel_sim.model import Model
from hasel_sim.parameter import value_with_error

from hasel_sysid.answer.diagnosis import Diagnosis, Finding, Verdict
from hasel_sysid.answer.next_run import Suggestion
from hasel_sysid.answer.result import Improvement, Status, WrongConstant
from hasel_sysid.comparison import Comparison
from hasel_sysid.improvement import listed
from hasel_sysid.report.content import KeyNumber, NextRun, ParameterRow, RankedRow, ReportContent, StageRow
from hasel_sysid.report.from_results import comparison_content, parameter_rows
from hasel_sysid.report.wording import beyond, error_text, of_effect, percent, remark

_SHOWN_SUGGESTIONS = 3
_NEWS = {
    Status.NOTHING_MISSING: True,
    Status.EXPLAINED: True,
    Status.PARTLY_EXPLAINED: None,
    Status.UNEXPLAINED: False,
}


def ranked_rows(diagnosis: Diagnosis) -> tuple[RankedRow, ...]:
    """Every effect that was considered, most probable first."""
    return tuple(_row(finding) for finding in diagnosis.findings)


def _row(finding: Finding) -> RankedRow:
    """What is absent has no estimate, and what it would imitate stands in its sentence: both are of another model."""
    effect = _effect(finding)
    told = finding.verdict is not Verdict.ABSENT and finding.is_plausible
    declared = {} if effect is None else {p.name: p for p in effect.parameters}
    expected = [
        ParameterRow(
            (own := name.rpartition(".")[2]),
            value,
            error,
            finding.units[name],
            remark=beyond(declared[own], value) if own in declared else "",
            plausible=of_effect(declared[own]) if own in declared else "",
        )
        for name, (value, error) in finding.expected.items()
    ]
    return RankedRow(
        finding.effect,
        finding.verdict.value,
        finding.probability,
        float("nan") if finding.verdict is Verdict.ABSENT else finding.error_removed,
        expected if told else (),
        finding.swallowed,
        "" if effect is None else effect.physics,
        str(finding),
    )


def _effect(finding: Finding) -> Effect | None:
    """The effect itself, of the catalogue or of a file of the user's."""
    if finding.source is not None:
        try:
            return find_effects((finding.source,))[0]
        except ModelError:
            return None
    return catalogue().get(finding.effect)


def diagnosis_content(diagnosis: Diagnosis, comparison: Comparison) -> ReportContent:
    """Report of a diagnosis of the fitted model that `comparison` shows."""
    content = comparison_content([comparison])
    first = diagnosis.best
    return replace(
        content,
        title="Which effect is missing?",
        verdict=str(first) if first else content.verdict,
        good=None,
        ranking=ranked_rows(diagnosis),
        groups=diagnosis.groups_in_question,
        remains=what_remains(diagnosis),
        noise_floor=diagnosis.measured.mean_absolute,
    )


def what_remains(diagnosis: Diagnosis) -> tuple[str, ...]:
    """How much of what a model leaves could be explained at all, and what else it may be."""
    said = [
        f"A small learned model of the residual would remove {diagnosis.ceiling:.0%} of the squared error above the "
        "noise: more than that nobody could explain.",
        f"Probability that it is none of the listed effects: {diagnosis.probability_none:.0%}.",
    ]
    said += [
        f"Finer numerics ({name.replace('_', ' ')}) would remove {share:.0%}."
        for name, share in diagnosis.suspects.items()
        if share > 0.05
    ]
    return tuple(said)


def improvement_content(
    improvement: Improvement,
    comparisons: Sequence[Comparison],
    start: Comparison | None = None,
    suggestions: Sequence[Suggestion] = (),
) -> ReportContent:
    """Report of an improvement.

    comparisons: of every stage, the fitted baseline first; start: of the baseline before it was fitted.
    """
    content = comparison_content(comparisons, detailed=-1)
    last = improvement.stages[-1]
    return replace(
        content,
        title=_title(improvement),
        verdict=_verdict(improvement),
        good=_NEWS[improvement.status],
        key_numbers=_key_numbers(improvement, comparisons),
        stages=_stages(comparisons, start, improvement.constant),
        noise_floor=improvement.noise_floor,
        ranking=tuple(_final(row, last.fit.model) for row in ranked_rows(improvement.diagnosis)),
        groups=improvement.diagnosis.groups_in_question,
        models=improvement.models,
        parameters=parameter_rows(
            last.fit.model, dict.fromkeys(last.fit.at_bound, "on its bound"), _before(comparisons, start)
        ),
        remains=_remains(improvement),
        messages=tuple(last.fit.sentences),
        next_runs=tuple(next_run(suggestion) for suggestion in suggestions[:_SHOWN_SUGGESTIONS]),
    )


def _before(comparisons: Sequence[Comparison], start: Comparison | None) -> Model | None:
    """The model to which the last one is compared: the fitted baseline, or what it was fitted from."""
    if len(comparisons) > 1:
        return comparisons[0].model
    return None if start is None else start.model


def _final(row: RankedRow, model: Model) -> RankedRow:
    """Of what was added the values are those of the model with all that was added, here as everywhere else."""
    values = [(each, model.parameters.get(f"{row.effect}.{each.name}")) for each in row.expected]
    return replace(
        row,
        expected=tuple(
            replace(
                each, value=known.value, standard_error=known.standard_error, remark=remark(known.name, model)
            )
            if known
            else each
            for each, known in values
        ),
    )


def _title(improvement: Improvement) -> str:
    if improvement.constant:
        return f"A number of the model file is wrong: {improvement.constant.name}"
    names = " and ".join(improvement.missing)
    return {
        Status.NOTHING_MISSING: "Nothing is missing from the model",
        Status.EXPLAINED: f"Missing: {names}",
        Status.PARTLY_EXPLAINED: f"Missing, in part: {names}",
        Status.UNEXPLAINED: "None of the listed effects explains the measurements",
    }[improvement.status]


def _verdict(improvement: Improvement) -> str:
    said = what_is_missing(improvement)
    more = (improvement.why, *improvement.contradictions, *improvement.open_values.values())
    return " ".join([said, *more] if said else more)


def what_is_missing(improvement: Improvement) -> str:
    """What was found missing, in a sentence; empty where nothing was."""
    missing, most = improvement.missing, "together they explain most of the error above the noise"
    if len(missing) < 2:
        return " ".join(str(improvement.diagnosis.finding(effect)) for effect in missing)
    sure = [effect for effect in missing if effect not in improvement.open_values]
    perhaps = [effect for effect in missing if effect in improvement.open_values]
    if not sure:
        return f"Perhaps {listed(perhaps)} are missing: {most}, and by itself each may do nothing."
    exchanged = [e for e in missing if improvement.diagnosis.finding(e).verdict is not Verdict.MISSING]
    why = [
        f" Of the effects that looked alike at first, {effect} fits best together with "
        f"{listed([e for e in missing if e != effect])}."
        for effect in exchanged
    ]
    also = f", and perhaps {listed(perhaps)}" if perhaps else ""
    return f"{listed(sure)} {'is' if len(sure) == 1 else 'are'} missing{also}: {most}.{''.join(why)}"


def _key_numbers(improvement: Improvement, comparisons: Sequence[Comparison]) -> tuple[KeyNumber, ...]:
    first, last = comparisons[0], comparisons[-1]
    numbers = []
    for label, before, after in (
        ("mean |Δ sin θ|, fitted runs", first.mean_absolute_error, last.mean_absolute_error),
        ("on unseen runs", first.mean_absolute_error_unseen, last.mean_absolute_error_unseen),
    ):
        if before is not None and after is not None:
            note = (
                f"from {error_text(before)} of the fitted baseline"
                if len(comparisons) > 1
                else "fitted baseline"
            )
            numbers.append(KeyNumber(error_text(after), label, note))
    numbers.append(
        KeyNumber(error_text(improvement.noise_floor), "noise floor", "what a perfect model would leave")
    )
    if not improvement.constant:
        explained = percent(1 - improvement.unexplained_fraction)
        numbers.append(KeyNumber(explained, "explained", "of the error above the noise"))
    return tuple(numbers)


def _stages(
    comparisons: Sequence[Comparison], start: Comparison | None, constant: WrongConstant | None
) -> tuple[StageRow, ...]:
    stages = []
    if start is not None:
        stages.append(
            StageRow("start", start.mean_absolute_error, start.mean_absolute_error_unseen, "before the fit")
        )
    known: set[str] = set()
    for comparison in comparisons:
        added = [name for name in _own_names(comparison.model, constant) if name not in known]
        label = "fit" if not stages or comparison is comparisons[0] else "+ " + ", ".join(added)
        values = [f"{name}: {_values(comparison, name)}" for name in added]
        stages.append(
            StageRow(
                label,
                comparison.mean_absolute_error,
                comparison.mean_absolute_error_unseen,
                "; ".join(values),
            )
        )
        known |= set(added)
    return tuple(stages)


def _own_names(model: Model, constant: WrongConstant | None) -> list[str]:
    """Effects of a model, and the constant where it is free."""
    found = [effect.id for effect in model.effects]
    return [*found, constant.name] if constant and constant.name in model.parameters else found


def _values(comparison: Comparison, added: str) -> str:
    """Of an effect's parameters, or of a constant."""
    found = {n: p for n, p in comparison.model.parameters.items() if n == added or n.startswith(f"{added}.")}
    return ", ".join(
        f"{name.removeprefix(added).removeprefix('.') or 'value'} = "
        f"{value_with_error(p.value, p.standard_error, p.unit)}"
        for name, p in found.items()
    )


def _remains(improvement: Improvement) -> tuple[str, ...]:
    if improvement.constant:
        return ()
    last = improvement.stages[-1].diagnosis
    left = f"{improvement.unexplained_fraction:.0%} of the baseline's error above the noise is left."
    return (left, *(() if last is None else what_remains(last)))


def next_run(suggestion: Suggestion) -> NextRun:
    """A suggestion as the report shows it."""
    names = sorted({name for pair in suggestion.pairs for name in pair})
    return NextRun(f"{suggestion.manoeuvre}.".capitalize(), suggestion.difference, names)
