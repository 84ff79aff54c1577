# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
from hasel_benchmark.bench_hidden.hidden_cases import PAIRS, Case, draw_values, list_cases, listed_effects
from hasel_benchmark.errors import BenchmarkError
from hasel_bringup.hidden_truth.hidden import both_signs
from hasel_sim.effects.registry import catalogue
from hasel_sim.model import load_model


@pytest.mark.parametrize("identity", list(catalogue()))
def test_hidden_values_are_plausible_and_not_null(identity):
    """Every effect of the catalogue can be hidden at half, one and two typical sizes, within its range."""
    for size in (0.5, 1.0, 2.0, -1.0):
        case = Case("single", (identity,), size, 0, "white", "near")
        values = draw_values(case, np.random.default_rng(0))[identity]
        effect = catalogue()[identity]
        assert all(p.lower <= values[p.name] <= p.upper for p in effect.parameters)
        assert any(values[p.name] != p.null for p in effect.parameters)
        first = effect.parameters[0]
        assert np.sign(values[first.name] - first.null) == (np.sign(size) if both_signs(identity) else 1)


def test_whole_benchmark_covers_what_it_must():
    """Every effect five times or more, nothing hidden forty times or more in both noises, pairs, unlisted effects."""
    cases = list_cases(("nothing", "single", "pair", "unlisted"), range(5), (), "near")
    assert len({case.name for case in cases}) == len(cases)
    for identity in listed_effects():
        sizes = [abs(case.size) for case in cases if case.kind == "single" and case.effects == (identity,)]
        assert len(sizes) >= 5
        assert set(sizes) == {0.5, 1.0, 2.0}
    nothing = [case.colour for case in cases if case.kind == "nothing"]
    assert len(nothing) >= 40
    assert nothing.count("white") == nothing.count("coloured")
    assert {case.effects for case in cases if case.kind == "pair"} == set(PAIRS)
    unlisted = [(case.effects, abs(case.size)) for case in cases if case.kind == "unlisted"]
    assert len({effects for effects, _ in unlisted}) >= 5
    assert all(unlisted.count((effects, size)) == 1 for effects, _ in unlisted for size in (0.5, 1.0, 2.0))


def test_every_single_effect_can_be_hidden_in_the_swimmer():
    """All of the catalogue but forces of a fluid that the swimmer's model file does not name."""
    for identity in listed_effects():
        load_model("swimmer").with_effects(identity)
    assert "quadratic_drag" in listed_effects()
    assert "finite_depth_added_mass" not in listed_effects()


def test_pairs_can_stand_side_by_side():
    """No pair holds two effects that the model refuses together."""
    for pair in PAIRS:
        assert len(load_model("swimmer").with_effects(*pair).effects) == 2


def test_unknown_effect_is_named_with_the_nearest():
    """A typing error in --effects is answered with the nearest effect."""
    with pytest.raises(BenchmarkError, match="quadratic_drag"):
        list_cases(("single",), [0], ("quadratic_drg",), "near")
