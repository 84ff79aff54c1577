"""What is known of an effect, for the person who decides whether to try it."""

from dataclasses import dataclass

from hasel_sim.effects.base import Effect
from hasel_sim.model import Model
from hasel_sim.parameter import value_with_error
from hasel_sysid.answer.diagnosis import Diagnosis, Finding
from hasel_sysid.candidates import candidate_effects
from hasel_sysid.report.wording import of_effect


@dataclass(frozen=True)
class Card:
    """effect: its id; physics: in a sentence; parameters: name with symbol and unit, plausible range with its source;
    signature: in the residual; said, verdict, probability, error_removed, expected: of a diagnosis, empty or None
    before one; on: whether the model has it.
    """

    effect: str
    place: str
    physics: str
    equation: str
    parameters: tuple[tuple[str, str], ...]
    signature: str
    confused_with: tuple[str, ...]
    separated_by: str
    citation: str
    on: bool = False
    said: str = ""
    verdict: str = ""
    probability: float | None = None
    error_removed: float | None = None
    expected: str = ""


def cards(model: Model, diagnosis: Diagnosis | None, only: tuple[str, ...] | None = None) -> list[Card]:
    """Of every effect that the model has or could have, the most probable first where a diagnosis has ranked them."""
    found = {} if diagnosis is None else {finding.effect: finding for finding in diagnosis.findings}
    own = [_card(effect, None, True) for effect in model.effects]
    others = [_card(effect, found.get(effect.id), False) for effect in candidate_effects(model, only)]
    order = {name: number for number, name in enumerate(found)}
    return own + sorted(others, key=lambda card: order.get(card.effect, len(order)))


def source_of(model: Model, effect: str, only: tuple[str, ...] | None = None) -> str:
    """By what name a model file knows an effect: its id, or the file that it is in."""
    known = {each.id: each for each in candidate_effects(model, only)}
    return (known[effect].source or effect) if effect in known else effect


def _card(effect: Effect, finding: Finding | None, on: bool) -> Card:
    parameters = tuple(
        (f"{p.name} ({p.symbol}){'' if p.unit == '1' else f' [{p.unit}]'}", of_effect(p))
        for p in effect.parameters
    )
    told: dict = {}
    if finding is not None:
        told = {
            "said": str(finding),
            "verdict": finding.verdict.value,
            "probability": finding.probability,
            "error_removed": finding.error_removed,
            "expected": _expected(finding),
        }
    return Card(
        effect.id,
        effect.place,
        effect.physics,
        effect.equation,
        parameters,
        effect.signature,
        effect.confused_with,
        effect.separated_by,
        effect.citation,
        on,
        **told,
    )


def _expected(finding: Finding) -> str:
    return ", ".join(
        f"{name.rpartition('.')[2]} = {value_with_error(value, error, finding.units[name])}"
        for name, (value, error) in finding.expected.items()
    )
