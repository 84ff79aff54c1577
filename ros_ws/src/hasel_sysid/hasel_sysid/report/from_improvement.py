"""The report's content from an improvement: the error falling, what was missing, what remains."""

from collections.abc import Sequence
from dataclasses import replace

from hasel_sim.effects.registry import find_effects
from hasel_sim.errors import ModelError

from hasel_sysid.compare.comparison import Comparison
from hasel_sysid.diagnosis import Diagnosis, Finding
from hasel_sysid.improve import Improvement, Status
from hasel_sysid.report.content import KeyNumber, NextRun, ParameterRow, RankedRow, ReportContent, Stage
from hasel_sysid.report.from_results import comparison_content, parameter_rows
from hasel_sysid.suggest import Suggestion

_SHOWN_SUGGESTIONS = 3


def improvement_content(
    improvement: Improvement, comparisons: Sequence[Comparison], suggestions: Sequence[Suggestion] = ()
) -> ReportContent:
    """Report of an improvement; comparisons: the first and the last model against all runs, in this order."""
    last = improvement.stages[-1]
    remarks = dict.fromkeys(last.fit.at_bound, "on its bound")
    return replace(
        comparison_content(comparisons),
        title=_title(improvement),
        verdict=improvement.reason,
        good=improvement.status in (Status.NOTHING_MISSING, Status.EXPLAINED),
        key_numbers=_key_numbers(improvement),
        stages=tuple(_stage(stage) for stage in improvement.stages),
        noise_floor=improvement.noise_floor,
        ranking=ranking_rows(improvement.diagnosis),
        groups=tuple(improvement.diagnosis.groups),
        parameters=parameter_rows(last.fit.model, remarks),
        remains=_remains(improvement),
        next_runs=tuple(
            NextRun(str(s), s.difference, tuple(sorted({name for pair in s.pairs for name in pair})))
            for s in suggestions[:_SHOWN_SUGGESTIONS]
        ),
        messages=tuple(last.fit.sentences),
    )


def ranking_rows(diagnosis: Diagnosis) -> tuple[RankedRow, ...]:
    """One row per effect, most probable first."""
    return tuple(_row(finding) for finding in diagnosis.findings)


def _row(finding: Finding) -> RankedRow:
    expected = tuple(
        ParameterRow(name, value, error, finding.units[name])
        for name, (value, error) in finding.expected.items()
    )
    try:
        physics = find_effects((finding.effect,))[0].physics
    except ModelError:
        physics = "an effect of your own"
    return RankedRow(
        finding.effect,
        finding.verdict.value,
        finding.probability,
        finding.error_removed,
        expected,
        finding.swallowed,
        physics,
        str(finding),
    )


def _title(improvement: Improvement) -> str:
    names = ", ".join(improvement.missing)
    return {
        Status.NOTHING_MISSING: "Nothing is missing from the model",
        Status.EXPLAINED: f"Missing: {names}",
        Status.PARTLY_EXPLAINED: f"Missing, in part: {names}",
        Status.UNEXPLAINED: "None of the listed effects explains the measurements",
    }[improvement.status]


def _stage(stage) -> Stage:
    label = "fitted baseline" if not stage.effects else f"+ {stage.effects[-1]}"
    return Stage(label, stage.mae_fit, stage.mae_validation)


def _key_numbers(improvement: Improvement) -> tuple[KeyNumber, ...]:
    first, last = improvement.stages[0], improvement.stages[-1]
    numbers = [KeyNumber(f"{last.mae_fit:.4f}", "mean |Δ sin θ|, fitted runs", f"from {first.mae_fit:.4f}")]
    if last.mae_validation is not None:
        numbers.append(
            KeyNumber(f"{last.mae_validation:.4f}", "on unseen runs", f"from {first.mae_validation:.4f}")
        )
    numbers.append(
        KeyNumber(f"{improvement.noise_floor:.4f}", "noise floor", "what a perfect model would leave")
    )
    numbers.append(KeyNumber(f"{improvement.unexplained_fraction:.0%}", "of the squared error unexplained"))
    return tuple(numbers)


def _remains(improvement: Improvement) -> tuple[str, ...]:
    sentences = [
        f"{improvement.unexplained_fraction:.0%} of the baseline's squared error above the noise is left; a small "
        f"learned model of the baseline's residual would remove {improvement.diagnosis.ceiling:.0%}."
    ]
    for name, share in improvement.diagnosis.suspects.items():
        sentences.append(f"A finer {name.replace('_', ' ')} would remove {share:.0%} of it.")
    return tuple(sentences)
