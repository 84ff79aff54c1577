"""The report's content from a diagnosis: the ranked effects and what remains."""

from dataclasses import replace

from hasel_sim.effects.registry import catalogue

from hasel_sysid.compare.comparison import Comparison
from hasel_sysid.diagnosis import Diagnosis
from hasel_sysid.diagnosis.result import Finding
from hasel_sysid.report.content import ParameterRow, RankedRow, ReportContent
from hasel_sysid.report.from_results import comparison_content


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
        groups=diagnosis.groups,
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
