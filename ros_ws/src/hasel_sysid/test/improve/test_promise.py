"""What other effects could take away of what is left, by their earlier signatures."""

from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sysid.improve.promise import most_promised

TIME = np.arange(600) / 120.0
FITTED = np.sin(2 * np.pi * TIME)[:, None]
LOOKS = np.sin(6 * np.pi * TIME)


def promised(residual, effects=()):
    """By one other effect, `drag`, whose signature is partly that of the fitted parameter."""
    columns = (LOOKS + 3.0 * FITTED[:, 0])[:, None]
    fit = SimpleNamespace(
        evaluation=SimpleNamespace(
            residual=residual, jacobian=FITTED, sum_of_squares=float(residual @ residual)
        ),
        model=SimpleNamespace(effects=[SimpleNamespace(id=name) for name in effects]),
    )
    found = SimpleNamespace(signatures={"drag": SimpleNamespace(columns=columns)})
    return most_promised(fit, found)


def test_what_looks_like_another_effect_is_promised():
    """The share of the square that lies along its signature, less what the fitted parameters imitate."""
    rest = np.cos(10 * np.pi * TIME)
    assert promised(LOOKS) == pytest.approx(1.0, abs=1e-3)
    assert promised(rest) == pytest.approx(0.0, abs=1e-3)
    assert promised(LOOKS + 2.0 * rest) == pytest.approx(0.2, abs=1e-2)


def test_an_effect_already_in_the_model_promises_nothing():
    """Its parameters are fitted."""
    assert promised(LOOKS, ("drag",)) == 0.0
