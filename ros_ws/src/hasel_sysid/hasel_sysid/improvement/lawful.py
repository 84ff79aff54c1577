"""Whether what was added is a law: one value of it for every voltage and frequency."""

from collections.abc import Sequence

from hasel_sysid.diagnosis.constancy import Trend, trends
from hasel_sysid.estimation import FitResult
from hasel_sysid.improvement.conclusion import last_diagnosis
from hasel_sysid.improvement.result import Stage
from hasel_sysid.noise import NoiseModel


def against_law(fit: FitResult, noise: NoiseModel, effects: Sequence[str]) -> list[Trend]:
    """What speaks against these effects of a fitted model being laws."""
    return [trend for trend in trends(fit, noise, effects) if trend.contradicts]


def effects_of(against: Sequence[Trend]) -> tuple[str, ...]:
    """The effects that these trends are of."""
    return tuple(dict.fromkeys(trend.parameter.partition(".")[0] for trend in against))


def without_contradictions(stages: Sequence[Stage]) -> tuple[list[Stage], tuple[str, ...], list[str]]:
    """The stages before the first that added what no one law can give, the effects not kept, what speaks against them.

    An effect whose size would have to change with voltage or frequency is reported and not added.
    """
    last = stages[-1]
    against = against_law(last.fit, last_diagnosis(stages).noise, last.effects)
    refused = effects_of(against)
    kept = [stage for stage in stages if not set(refused) & set(stage.effects)]
    return kept, refused, [str(trend) for trend in against]
