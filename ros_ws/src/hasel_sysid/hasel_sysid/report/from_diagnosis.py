"""The report's content from a diagnosis or an improvement."""

from collections.abc import Sequence
from dataclasses import replace

from hasel_sim.effects.registry import catalogue

from hasel_sysid.compare.comparison import Comparison
from hasel_sysid.diagnosis import Diagnosis
from hasel_sysid.diagnosis.result import Finding
from hasel_sysid.improve.result import Improvement, Status
from hasel_sysid.report.content import KeyNumber, NextRun, ParameterRow, RankedRow, ReportContent, Stage
from hasel_sysid.report.from_results import comparison_content, parameter_rows

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
    expected = [
        ParameterRow(name.rpartition(".")[2], value, error, finding.units[name])
        for name, (value, error) in finding.expected.items()
    ]
    known = catalogue().get(finding.effect)
    return RankedRow(
        finding.effect,
        finding.verdict.value,
        finding.probability,
        finding.error_removed,
        expected,
        finding.swallowed,
        "" if known is None else known.physics,
        str(finding),
    )


def diagnosis_content(
    diagnosis: Diagnosis, comparison: Comparison, next_runs: Sequence[NextRun] = ()
) -> ReportContent:
    """Report of a diagnosis of the fitted model that `comparison` shows."""
    content = comparison_content([comparison])
    first = diagnosis.best
    return replace(
        content,
        title="Which effect is missing?",
        verdict=str(first) if first else content.verdict,
        good=None,
        ranking=ranked_rows(diagnosis),
        groups=diagnosis.groups,
        remains=_remains(diagnosis),
        noise_floor=diagnosis.noise.mean_absolute,
        next_runs=next_runs,
    )


def improvement_content(
    improvement: Improvement,
    comparisons: Sequence[Comparison],
    start: Comparison | None = None,
    next_runs: Sequence[NextRun] = (),
) -> ReportContent:
    """Report of an improvement.

    comparisons: of every stage, the fitted baseline first; start: of the baseline before it was fitted.
    """
    content = comparison_content(comparisons)
    last = improvement.stages[-1]
    return replace(
        content,
        title=_title(improvement),
        verdict=improvement.reason,
        good=_NEWS[improvement.status],
        key_numbers=_key_numbers(improvement, comparisons),
        stages=_stages(comparisons, start),
        noise_floor=improvement.noise_floor,
        ranking=ranked_rows(improvement.diagnosis),
        groups=improvement.diagnosis.groups,
        parameters=parameter_rows(last.fit.model, dict.fromkeys(last.fit.at_bound, "on its bound")),
        remains=_remains(last.diagnosis or improvement.diagnosis, improvement),
        messages=tuple(last.fit.sentences),
        next_runs=next_runs,
    )


def _title(improvement: Improvement) -> str:
    if improvement.status is Status.NOTHING_MISSING:
        return "Nothing is missing"
    if not improvement.missing:
        return "None of the listed effects explains what is left"
    return f"Missing: {' and '.join(improvement.missing)}"


def _key_numbers(improvement: Improvement, comparisons: Sequence[Comparison]) -> tuple[KeyNumber, ...]:
    first, last = comparisons[0], comparisons[-1]
    numbers = []
    for label, before, after in (
        ("mean |Δ sin θ|, fitted runs", first.mean_absolute_error, last.mean_absolute_error),
        ("on unseen runs", first.mean_absolute_error_unseen, last.mean_absolute_error_unseen),
    ):
        if before is not None and after is not None:
            note = f"from {before:.4f} of the fitted baseline" if len(comparisons) > 1 else "fitted baseline"
            numbers.append(KeyNumber(f"{after:.4f}", label, note))
    numbers.append(
        KeyNumber(f"{improvement.noise_floor:.4f}", "noise floor", "what a perfect model would leave")
    )
    explained = f"{1 - improvement.unexplained_fraction:.0%}"
    numbers.append(KeyNumber(explained, "explained", "of the squared error above the noise"))
    return tuple(numbers)


def _stages(comparisons: Sequence[Comparison], start: Comparison | None) -> tuple[Stage, ...]:
    stages = []
    if start is not None:
        stages.append(
            Stage("start", start.mean_absolute_error, start.mean_absolute_error_unseen, "before the fit")
        )
    known: set[str] = set()
    for comparison in comparisons:
        added = [effect.id for effect in comparison.model.effects if effect.id not in known]
        label = "fit" if not stages or comparison is comparisons[0] else "+ " + ", ".join(added)
        values = [f"{effect}: {_values(comparison, effect)}" for effect in added]
        stages.append(
            Stage(
                label,
                comparison.mean_absolute_error,
                comparison.mean_absolute_error_unseen,
                "; ".join(values),
            )
        )
        known |= set(added)
    return tuple(stages)


def _values(comparison: Comparison, effect: str) -> str:
    found = [p for name, p in comparison.model.parameters.items() if name.startswith(f"{effect}.")]
    return ", ".join(str(p).removeprefix(f"{effect}.") for p in found)


def _remains(diagnosis: Diagnosis, improvement: Improvement | None = None) -> tuple[str, ...]:
    said = []
    if improvement is not None:
        said.append(f"{improvement.unexplained_fraction:.0%} of the squared error above the noise is left.")
    said.append(
        f"A small learned model of the residual could remove {diagnosis.ceiling:.0%} of the error left."
    )
    said.append(f"Probability that it is none of the listed effects: {diagnosis.probability_none:.0%}.")
    said += [
        f"Finer numerics ({name.replace('_', ' ')}) would remove {share:.0%}."
        for name, share in diagnosis.suspects.items()
        if share > 0.05
    ]
    return tuple(said)
