"""Second thoughts: what the first diagnosis would have said, had it fitted in full what only a detour led to."""

from collections.abc import Sequence
from dataclasses import replace

from hasel_sysid.diagnosis import judged
from hasel_sysid.improve.result import Stage


def with_hindsight(stages: Sequence[Stage]) -> Stage:
    """The baseline, its effects ranked again where one effect that was not its best turned out to explain all.

    A very soft spine may first look like a payload; once it is there the payload goes, and the ranking must not still
    put the payload first.
    """
    first, last = stages[0], stages[-1]
    found = first.diagnosis
    best = found.best
    if len(last.effects) != 1 or (best is not None and best.effect == last.effects[0]):
        return first
    return replace(first, diagnosis=judged(found.context.with_fit(last.effects[0], last.fit)))
