"""Which effects can stand side by side on a body."""

from hasel_sim.effects.base import Effect
from hasel_sim.errors import ModelError
from hasel_sim.model.description import Description


def check_together(effects: tuple[Effect, ...], body: Description) -> None:
    """Refuse effects that cannot stand side by side, or not on this body, with a ModelError."""
    seen: dict[str, str] = {}
    for effect in effects:
        for word in filter(None, (effect.id, effect.exclusive)):
            if word in seen:
                reason = "is there twice" if seen[word] == effect.id else f"does the same as '{seen[word]}'"
                raise ModelError(
                    f"effect '{effect.id}' {reason}; expected one of each kind: remove one of the two"
                )
            seen[word] = effect.id
        if effect.needs_muscles and not body.muscles:
            raise ModelError(
                f"effect '{effect.id}' acts on the muscles, and model '{body.name}' has none; "
                "remove it or use a model with muscles"
            )
        if effect.needs_spine and body.body.spine is None:
            raise ModelError(
                f"effect '{effect.id}' acts on the spine, and model '{body.name}' has none; "
                "remove it or use a model whose body has a spine"
            )
        count = len(body.muscles)
        if effect.needs_antagonists and count != 2:
            raise ModelError(
                f"effect '{effect.id}' compares two muscles, and model '{body.name}' has {count}; remove it or use a "
                "model with two"
            )
        if effect.needs_medium and body.medium is None:
            raise ModelError(
                f"effect '{effect.id}' is a force of the fluid around the body, and model '{body.name}' names none; "
                "remove it or add a section medium"
            )
        quantities = sorted({channel.quantity for channel in body.channels})
        if effect.quantity and effect.quantity not in quantities:
            raise ModelError(
                f"effect '{effect.id}' acts on a {effect.quantity}, and model '{body.name}' is driven by "
                f"{', '.join(quantities) or 'nothing'}; remove it or use a model with such a channel"
            )
