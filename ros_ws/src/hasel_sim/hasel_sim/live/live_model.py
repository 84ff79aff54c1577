"""The model that a node simulates, driven by the two voltages of the HASEL rig."""

import numpy as np

from hasel_sim.drive.schedule import HASEL_CHANNELS
from hasel_sim.errors import ModelError
from hasel_sim.model import Model, load_model

_LEVEL_WITHOUT_FIT = 5500.0


def live_model(name: str, effects: tuple[str, ...] = ()) -> tuple[Model, str]:
    """A model by name or file, with further effects, and a warning (else empty).

    A model with muscles that was never fitted has no amplitudes: it gets one, so that it moves. Raises ModelError, also
    for a body that is driven by something else than the rig's voltages.
    """
    model, warning = load_model(name), ""
    rig_columns(model)
    if model.has_muscles and len(model.levels) == 0 and model.description.muscle is None:
        model = model.with_levels(np.array([_LEVEL_WITHOUT_FIT]))
        start = model.parameters[f"amplitude_{_LEVEL_WITHOUT_FIT:g}"].value
        warning = (
            f"model '{name}' was never fitted: its contraction is taken as {start:g} at {_LEVEL_WITHOUT_FIT:g} V, "
            "in proportion to the voltage; fit it, or load a fitted model file"
        )
    return model.with_effects(*effects), warning


def rig_columns(model: Model) -> list[int]:
    """Which of the supply's two voltages drives each channel. Raises ModelError where a channel is not one of them."""
    for channel in model.description.channels:
        if channel.quantity != "voltage" or channel.name not in HASEL_CHANNELS:
            raise ModelError(
                f"model '{model.name}' is driven by the {channel.quantity} '{channel.name}', and the supply reports "
                f"the voltages {' and '.join(HASEL_CHANNELS)} only: simulate its recordings with compare, or choose "
                "a model with these channels"
            )
    return [HASEL_CHANNELS.index(name) for name in model.channels]
