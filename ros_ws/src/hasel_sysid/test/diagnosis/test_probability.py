"""Probabilities of the effects and of none of them."""

from dataclasses import replace

import pytest
from hasel_sysid.diagnosis.probability import probabilities


def test_the_effect_that_is_there_and_its_double_share_it(context):
    """What cannot tell two effects apart leaves both probable, and no third one."""
    found, none = probabilities(context(0.01))
    assert none == pytest.approx(0.0, abs=0.01)
    assert found["sine"] + found["much_alike"] == pytest.approx(1.0, abs=0.01)
    assert found["other"] == pytest.approx(0.0, abs=1e-6)


def test_what_no_effect_removes_speaks_for_none_of_them(context):
    """When the right effect is not among the candidates, none of them is probable."""
    whole = context(0.1)
    squares = {name: whole.squares[name] for name in ("other", "swallowed")}
    finals = {name: whole.finals[name] for name in squares}
    found, none = probabilities(replace(whole, squares=squares, finals=finals))
    assert none > 0.95
    assert max(found.values()) < 0.05


def test_noise_makes_nothing_probable(context):
    """Where noise alone looks like this, every effect has probability zero."""
    found, none = probabilities(context(0.0, chance=0.5))
    assert none == 1.0 and set(found.values()) == {0.0}
