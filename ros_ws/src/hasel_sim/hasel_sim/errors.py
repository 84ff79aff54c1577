"""What can go wrong when a model is described or simulated; every message is one sentence with a next step."""

import difflib
from collections.abc import Iterable


class HaselSimError(Exception):
    """Base of every error this package raises on purpose."""


class ModelError(HaselSimError):
    """A model file, effect or parameter that cannot be used as written."""


class SimulationError(HaselSimError):
    """A simulation that could not be carried out or did not converge."""


def nearest_name(name: str, known: Iterable[str]) -> str:
    """Return "; the nearest known one is 'x'" or the list of what is known, for the end of a message."""
    known = sorted(known)
    match = difflib.get_close_matches(name, known, n=1, cutoff=0.5)
    if match:
        return f"the nearest known one is '{match[0]}'"
    return f"known are {', '.join(known)}" if known else "none is known"
