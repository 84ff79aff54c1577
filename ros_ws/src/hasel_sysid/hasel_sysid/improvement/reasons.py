"""Why a stage is the last one, in a sentence."""

from collections.abc import Sequence

from hasel_sysid.data_gate import Finding
from hasel_sysid.diagnosis import Diagnosis
from hasel_sysid.diagnosis.explained import near_noise
from hasel_sysid.improvement.result import Stage
from hasel_sysid.improvement.wrong_constant import WrongConstant
from hasel_sysid.policy import Policy
from hasel_sysid.selection import Choice, Searched
from hasel_sysid.selection.sets import EffectSet, name_of
from hasel_sysid.time_limit import TimeLimit

_CREDIT = (
    "takes away a tenth of the squared error that finer numerics leave and foretells left-out runs better"
)


def why_the_last(
    found: Searched,
    choice: Choice,
    policy: Policy,
    first: Stage,
    opposed: Sequence[Finding],
    constant: WrongConstant | None,
) -> tuple[str, bool]:
    """The sentence, and whether nothing else is missing; what comes before any effect comes first."""
    if opposed:
        reason, done = f"A fault of the set-up comes before any effect: {' '.join(map(str, opposed))}", False
    elif constant:
        reason, done = str(constant), False
    else:
        reason, done = _why_here(found, choice, policy, first)
        if choice.lawless:
            reason = f"{reason} {' and '.join(map(name_of, choice.lawless))} would do as well, but by no law."
    return reason, done


def too_little(effects: Sequence[str], left: float) -> str:
    """Why effects that leave this share of the error above the noise are not added."""
    return (
        f"{listed(effects)} would take away {1 - left:.0%} of the error above the noise, which explains too "
        "little of it: not added."
    )


def by_no_law(effects: Sequence[str]) -> str:
    """Why effects are not added whose size would have to change."""
    return f"{listed(effects)} would lower the error, but by no law: not added."


def what_was_not_tried(time_limit: TimeLimit, first: Diagnosis) -> str:
    """What there was no time for, in a sentence; empty where there was time for everything."""
    if not time_limit.left_something_out:
        return ""
    untried = f"not tried: {', '.join(first.not_tried)}" if first.not_tried else ""
    return f"The search ended at {time_limit}; {untried or 'not every set of effects was tried'}."


def _why_here(found: Searched, choice: Choice, policy: Policy, first: Stage) -> tuple[str, bool]:
    """Why the chosen set is the last, in a sentence, and whether nothing else is missing."""
    chance = found.tested(choice.chosen).chance
    nothing_else = chance >= policy.level
    looked_at = "effects that were tried" if first.diagnosis.not_tried else "listed effects"
    if not choice.chosen:
        if nothing_else and near_noise(first.mae_fit, first.diagnosis.noise):
            return f"Nothing is missing: noise alone looks like this in {chance:.0%} of cases.", True
        if nothing_else:
            return f"None of the {looked_at} stands out from what is left.", False
        trifle = near_noise(first.mae_fit, first.diagnosis.noise)
        what = "Nothing that matters is missing: none" if trifle else "Something is missing, but none"
        return (
            f"{what} of the {looked_at} foretells runs that are left out of the fit better than no effect does.",
            trifle,
        )
    added = listed(in_order(choice, choice.chosen))
    if nothing_else:
        return f"What is left after adding {added} looks like no other effect.", True
    if len(choice.chosen) >= policy.most_effects:
        return f"Effect {policy.most_effects} was the last: more effects could imitate anything.", False
    nearest = f"; nearest was {name_of(found.best)}" if found.best != choice.chosen else ""
    return (
        f"After adding {added} something is still missing, but none of the other {looked_at} {_CREDIT}{nearest}.",
        False,
    )


def in_order(choice: Choice, effects: EffectSet) -> tuple[str, ...]:
    """Effects of a set in the order in which the path to the chosen one takes them in."""
    order: list[str] = []
    for step in choice.path:
        order += sorted(step - set(order))
    return tuple(effect for effect in order if effect in effects)


def listed(names: Sequence[str]) -> str:
    """Names in a sentence: a, b and c."""
    return " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))
