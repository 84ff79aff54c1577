"""The model that a node simulates."""

import numpy as np

from hasel_sim.model import Model, load_model

_LEVEL_WITHOUT_FIT = 5500.0


def live_model(name: str, effects: tuple[str, ...] = ()) -> tuple[Model, str]:
    """A model by name or file, with further effects, and a warning (else empty).

    A model with muscles that was never fitted has no amplitudes: it gets one, so that it moves. Raises ModelError.
    """
    model, warning = load_model(name), ""
    if model.has_muscles and len(model.levels) == 0:
        model = model.with_levels(np.array([_LEVEL_WITHOUT_FIT]))
        start = model.parameters[f"amplitude_{_LEVEL_WITHOUT_FIT:g}"].value
        warning = (
            f"model '{name}' was never fitted: its contraction is taken as {start:g} at {_LEVEL_WITHOUT_FIT:g} V, "
            "in proportion to the voltage; fit it, or load a fitted model file"
        )
    return model.with_effects(*effects), warning
