"""What other effects could take away of what is left, by their earlier signatures."""

from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sysid.diagnosis.promise import carried_over, promised_shares, worth_trying
from hasel_sysid.diagnosis.signature import Signature

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
    return promised_shares(fit, {"drag": SimpleNamespace(columns=columns)}).get("drag", 0.0)


def test_what_looks_like_another_effect_is_promised():
    """The share of the square that lies along its signature, less what the fitted parameters imitate."""
    rest = np.cos(10 * np.pi * TIME)
    assert promised(LOOKS) == pytest.approx(1.0, abs=1e-3)
    assert promised(rest) == pytest.approx(0.0, abs=1e-3)
    assert promised(LOOKS + 2.0 * rest) == pytest.approx(0.2, abs=1e-2)


def test_an_effect_already_in_the_model_promises_nothing():
    """Its parameters are fitted."""
    assert promised(LOOKS, ("drag",)) == 0.0


def test_what_promises_next_to_nothing_is_not_tried_again():
    """What has no earlier signature is, and so are the best three in any case."""
    shapes = {f"waves_{n}": np.sin(2 * np.pi * n * TIME) for n in range(3, 9)}
    residual = (
        shapes["waves_3"] + 0.3 * shapes["waves_4"] + 0.1 * shapes["waves_5"] + 0.05 * shapes["waves_6"]
    )
    signatures = {name: SimpleNamespace(columns=shape[:, None]) for name, shape in shapes.items()}
    fit = SimpleNamespace(
        evaluation=SimpleNamespace(
            residual=residual, jacobian=FITTED, sum_of_squares=float(residual @ residual)
        ),
        model=SimpleNamespace(effects=[]),
    )
    effects = [SimpleNamespace(id=name) for name in (*shapes, "unknown")]
    chosen = [effect.id for effect in worth_trying(fit, effects, signatures)]
    assert chosen == ["waves_3", "waves_4", "waves_5", "unknown"]
    assert worth_trying(fit, effects, {}) == effects


def test_a_signature_carried_over_leaves_what_the_new_fit_cannot_imitate():
    """The change stays; the part along the new fit's derivatives is imitated."""
    change = LOOKS + FITTED[:, 0]
    fit = SimpleNamespace(evaluation=SimpleNamespace(jacobian=FITTED))
    old = Signature("drag", change, change, change[:, None], 0.0, 1.0)
    new = carried_over(fit, old)
    np.testing.assert_allclose(new.left, LOOKS, atol=1e-9)
    assert new.change is old.change
