"""What an answer says of values that stay open."""

import numpy as np
import pytest
from hasel_sim.model import load_model
from hasel_sysid.improvement.open_values import open_values

NAMES = ("soft_modulus.scale", "strain_softening.softening", "payload.mass")
EFFECTS = ("soft_modulus", "strain_softening", "payload")


def fitted(errors, correlation=0.0):
    """A beam that is softer, softens and carries 1.7 kg/m; the first two of these errors are correlated."""
    model = (
        load_model("beam").with_effects(*EFFECTS).with_values(dict(zip(NAMES, (0.6, 0.4, 1.7), strict=True)))
    )
    covariance = np.diag(np.square(errors))
    covariance[0, 1] = covariance[1, 0] = correlation * errors[0] * errors[1]
    return model.with_covariance(NAMES, covariance)


def test_two_of_which_only_the_sum_is_known_are_said_to_be_so():
    """Softer by itself, or softer when strained: both intervals hold the value at which the effect does nothing."""
    found = open_values(fitted((1.6, 1.7, 0.1), -0.999), EFFECTS)
    softer, softening = found["soft_modulus"], found["strain_softening"]
    assert softer == (
        "soft_modulus.scale is not known: its interval holds 1, at which it does nothing; "
        "strain_softening.softening can do the same (correlation -1.00)."
    )
    assert softening.startswith("strain_softening.softening is not known: its interval holds 0,")


def test_what_nothing_else_can_do_is_still_not_known():
    """A wide interval alone is said as well, without naming another."""
    found = open_values(fitted((0.01, 0.01, 1.0)), EFFECTS)
    assert list(found) == ["payload"]
    assert (
        found["payload"] == "payload.mass is not known: its interval holds 0 kg/m, at which it does nothing."
    )


@pytest.mark.parametrize("correlation", [0.0, 0.999])
def test_of_values_that_are_known_nothing_is_said(correlation):
    """However much two of them go together."""
    assert open_values(fitted((0.01, 0.01, 0.1), correlation), EFFECTS) == {}


def test_only_what_was_added_is_spoken_of():
    """An effect that the model had before is no answer."""
    assert open_values(fitted((1.6, 1.7, 0.1), -0.999), ("payload",)) == {}
