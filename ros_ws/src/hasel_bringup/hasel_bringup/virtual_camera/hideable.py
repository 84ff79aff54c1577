"""What can be hidden in the virtual swimmer."""

from hasel_common.names import nearest_name

from hasel_bringup.errors import BringupError

RANDOM, NOTHING = "random", "none"


def hideable() -> list[str]:
    """Effects that change how the body moves: those of the observation would not show in a picture of its markers."""
    from hasel_sim.effects.base import ObservationEffect
    from hasel_sim.effects.registry import catalogue

    return [name for name, effect in catalogue().items() if not isinstance(effect, ObservationEffect)]


def check_hidden(word: str) -> None:
    """Raises BringupError for a word that is neither an effect that can be hidden, nor `random` or `none`."""
    if word not in (RANDOM, NOTHING) and word not in (known := hideable()):
        raise BringupError(
            f"'{word}' cannot be hidden; expected {RANDOM}, {NOTHING} or an effect that moves the body: "
            f"{nearest_name(word, known)}"
        )
