"""The report's content from a diagnosis: the ranked effects and what remains."""

from dataclasses import replace

from hasel_sim.effects.base import Effect
from hasel_sim.effects.registry import catalogue, find_effects
from hasel_sim.errors import ModelError

from hasel_sysid.compare.comparison import Comparison
from hasel_sysid.diagnosis import Diagnosis, Finding, Verdict
from hasel_sysid.report.content import ParameterRow, RankedRow, ReportContent
from hasel_sysid.report.from_results import comparison_content
from hasel_sysid.report.parameter_words import beyond, of_effect


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
