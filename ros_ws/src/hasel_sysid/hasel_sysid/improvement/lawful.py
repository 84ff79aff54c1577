"""Whether what was added is a law: one value of it for every voltage and frequency."""

from collections.abc import Sequence

from hasel_sysid.diagnosis.constancy import trends
from hasel_sysid.improvement.conclusion import last_diagnosis
from hasel_sysid.improvement.result import Stage


def without_contradictions(stages: Sequence[Stage]) -> tuple[list[Stage], tuple[str, ...], list[str]]:
    """The stages before the first that added what no one law can give, the effects not kept, what speaks against them.

    An effect whose size would have to change with voltage or frequency is reported and not added.
    """
    last = stages[-1]
    against = [t for t in trends(last.fit, last_diagnosis(stages).noise, last.effects) if t.contradicts]
    refused = tuple(dict.fromkeys(trend.parameter.partition(".")[0] for trend in against))
    kept = [stage for stage in stages if not set(refused) & set(stage.effects)]
    return kept, refused, [str(trend) for trend in against]
