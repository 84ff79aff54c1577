# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The answer among fitted models: one-standard-error rule, backward check and model confidence set."""

from itertools import combinations

import numpy as np
import pytest
from hasel_sysid.policy import POLICY
from hasel_sysid.selection.choose import best_of, choose, compare
from hasel_sysid.testing.linear_world import (
    SLOW,
    WHITE,
    LinearWorld,
    not_excused,
    run_numbers,
    smooth_series,
    unlike_series,
)


def every_set(names: str, most: int = 3) -> list[str]:
    """All sets of so many names at most."""
    return ["".join(s) for size in range(most + 1) for s in combinations(names, size)]


@pytest.mark.parametrize("noise", [WHITE, SLOW], ids=["white", "shared by neighbours"])
@pytest.mark.parametrize(
    "sizes", [{}, {"c": 0.03}, {"c": 0.03, "e": -0.02}, {"a": 0.02, "d": 0.02, "e": 0.03}]
)
def test_what_is_there_is_chosen(sizes, noise):
    """None, one, two or three effects, each as large as the noise or smaller, and nothing beside them."""
    for seed in range(2):
        found = LinearWorld(unlike_series(seed, "abcde"), sizes, noise, seed).choice(every_set("abcde"))
        assert found.chosen == set(sizes)
        assert sum(found.weights.values()) == pytest.approx(1.0)
        assert set(found.in_order) == set(sizes)


def test_noise_is_taken_for_noise():
    """Of thirty draws no more than two are taken for an effect, though five are offered and none is there."""
    false = 0
    for seed in range(30):
        world = LinearWorld(unlike_series(seed, "abcde"), {}, WHITE, seed)
        false += bool(world.choice(every_set("abcde", 1)).chosen)
    assert false <= 2


def test_of_sets_within_one_standard_error_of_the_best_the_smallest_is_taken():
    """One-standard-error rule: a second effect that is there, and gains less than the error of its gain, stays out."""
    for seed in range(5):
        world = LinearWorld(unlike_series(seed, "abc"), {"a": 0.05, "b": 0.002}, WHITE, seed)
        models = world.judged(world.fitted(s) for s in every_set("abc"))
        found = choose(models, POLICY, 0.0, not_excused, lambda *_: 0.0, lambda _: True)
        best = models[best_of(models)].elpd
        as_good = [
            names
            for names, one in models.items()
            if (more := best.over(one.elpd)).total <= POLICY.standard_errors * more.error
        ]
        assert len(found.chosen) <= min(map(len, as_good))


@pytest.mark.parametrize("threshold", [0.0, 5.0])
def test_no_candidate_stays_whose_removal_costs_less_than_one_standard_error(threshold):
    """Backward check, where one effect is strong and two are hardly seen; each must also gain more than noise does."""
    for seed in range(8):
        sizes = {"a": 0.05, "b": 0.0034, "c": -0.0034}
        world = LinearWorld(unlike_series(seed, "abcde"), sizes, WHITE, seed)
        models = world.judged(world.fitted(s) for s in every_set("abcde"))
        whole = choose(models, POLICY, threshold, not_excused, lambda *_: 0.0, lambda _: True).chosen
        for gone in whole:
            more = models[whole].elpd.over(models[whole - {gone}].elpd)
            assert more.total > POLICY.standard_errors * more.error
            gain = models[whole].whitened.logarithm - models[whole - {gone}].whitened.logarithm
            assert gain > threshold


def test_what_only_stood_in_for_two_others_goes():
    """The likeliest single effect is a mixture of the two that are there."""
    for seed in range(3):
        series = unlike_series(seed, "abc")
        series["c"] = series["a"] + series["b"] + 0.5 * series["c"]
        world = LinearWorld(series, {"a": 0.05, "b": 0.04}, WHITE, seed)
        assert world.choice(every_set("abc")).chosen == {"a", "b"}


def test_what_one_run_alone_asks_for_is_not_added():
    """A disturbance of a single run looks like an effect there, and the other runs know nothing of it."""
    for seed in range(3):
        series = unlike_series(seed, "abc")
        disturbed = np.where(run_numbers() == 3, 0.08 * series["a"], 0.0)
        found = LinearWorld(series, {}, WHITE, seed, stranger=disturbed).choice(every_set("abc"))
        assert found.chosen == frozenset()


def test_twins_are_a_group():
    """Model confidence set: an effect whose series differs by less than the noise shows stands beside the chosen."""
    for seed in range(3):
        series = unlike_series(seed, "abcd")
        series["b"] = series["a"] + 0.01 * series["b"]
        found = LinearWorld(series, {"a": 0.1, "d": 0.2}, WHITE, seed).choice(every_set("abcd"))
        assert found.chosen in ({"a", "d"}, {"b", "d"})
        assert found.groups == (("a", "b"),)
        assert set(found.rivals) == {frozenset("ad"), frozenset("bd")}
        assert 0.02 < found.weight_of("a") < 0.98


def test_what_the_recordings_tell_apart_is_no_group():
    """Its weight is that of certainty."""
    found = LinearWorld(unlike_series(1, "abc"), {"a": 0.05}, WHITE, 1).choice(every_set("abc"))
    assert found.groups == ()
    assert found.weight_of("a") > 0.95


def test_two_that_stand_for_two_others_are_groups_of_those_they_look_like():
    """Exchanged one by one they would be told apart."""
    series = unlike_series(6, "abfgj")
    shift = 0.5 * series["j"]
    series["b"], series["g"] = series["a"] + shift, series["f"] - shift
    found = LinearWorld(series, {"a": 0.05, "f": 0.05}, WHITE, 6).choice(every_set("abfg", 2))
    assert found.chosen in ({"a", "f"}, {"b", "g"})
    assert found.groups == (("a", "b"), ("f", "g"))


def test_what_is_left_beside_hardly_any_noise_makes_no_certainty():
    """Of two that leave the same of what neither describes, the runs do not agree which is better: a group."""
    stranger = 0.02 * np.random.default_rng(99).standard_normal(len(run_numbers()))
    series = unlike_series(5, "abc")
    series["b"] = series["a"] + 0.002 * series["b"]
    world = LinearWorld(series, {"a": 0.3}, WHITE, 5, stranger=stranger)
    assert world.choice(every_set("abc", 1)).groups == (("a", "b"),)


def test_an_effect_that_does_nothing_stands_for_no_other():
    """While a stranger leaves much, what takes nothing away is no law in the chosen one's place."""
    stranger = smooth_series(np.random.default_rng(4), run_numbers())
    world = LinearWorld(unlike_series(1, "abc"), {"c": 0.42}, WHITE, 1, stranger)
    found = world.choice(every_set("abc", 1), is_law=lambda names: names != frozenset("c"))
    assert found.chosen == {"c"}
    assert found.rivals == (frozenset("c"),) and not found.groups


def test_of_sets_that_cannot_be_told_apart_one_that_is_a_law_is_taken():
    """The other is named for what it is; it stays where nothing else will do."""
    series = unlike_series(2, "abd")
    series["b"] = series["a"] + 0.01 * series["b"]
    world = LinearWorld(series, {"a": 0.1, "d": 0.3}, WHITE, 2)
    likelier = world.choice(every_set("abd")).chosen
    other = likelier ^ {"a", "b"}
    found = world.choice(every_set("abd"), is_law=lambda names: names != likelier)
    assert (found.chosen, found.no_laws, found.rivals) == (other, (likelier,), (other,))
    assert found.path[-1] == other and not found.groups
    none = world.choice(every_set("abd"), is_law=lambda names: False)
    assert (none.chosen, none.no_laws) == (likelier, ())


@pytest.mark.parametrize("apart", [False, True], ids=["alike", "told apart"])
def test_of_sets_that_cannot_be_told_apart_one_inside_its_ranges_comes_first(apart):
    """One that predicts a little better, but on the edge of a range, is left in the group; what is better stays."""
    series = unlike_series(2, "abd")
    series["b"] = series["a"] + (1.0 if apart else 0.01) * series["b"]
    world = LinearWorld(series, {"a": 0.1, "d": 0.3}, WHITE, 2)
    first = world.choice(every_set("abd")).chosen
    found = world.choice(every_set("abd"), on_edge=[first])
    assert found.chosen == (first if apart else first ^ {"a", "b"})
    assert found.groups == (() if apart else (("a", "b"),))


def test_the_path_leads_from_nothing_to_the_answer_one_at_a_time():
    """The larger effect first."""
    world = LinearWorld(unlike_series(4, "abc"), {"a": 0.03, "b": 0.1, "c": 0.05}, WHITE, 4)
    found = world.choice(every_set("abc"))
    assert [len(step) for step in found.path] == [0, 1, 2, 3]
    assert all(less < more for less, more in zip(found.path, found.path[1:], strict=False))
    assert found.in_order == ("b", "c", "a")


def test_what_no_model_has_excuses_the_lack_of_a_small_effect():
    """However sure it is, and only where what it changes is that small."""
    world = LinearWorld(unlike_series(3, "ab"), {"a": 0.05}, WHITE, 3)
    models = world.judged(world.fitted(s) for s in every_set("ab", 2))

    def chosen(discrepancy):
        def excused(_, change):
            return np.sqrt(np.mean(change**2)) <= discrepancy

        return choose(models, POLICY, 0.0, excused, lambda *_: 0.0, lambda _: True).chosen

    assert chosen(0.03) == {"a"}
    assert chosen(0.08) == frozenset()


def test_the_table_of_models_is_that_of_arviz():
    """Best elpd first, differences to it with their errors, weights that add up to one, and why each is not taken."""
    world = LinearWorld(unlike_series(1, "abc"), {"a": 0.05}, WHITE, 1)
    models = world.judged(world.fitted(s) for s in every_set("abc", 2))
    found = choose(models, POLICY, 5.0, not_excused, lambda *_: 0.0, lambda _: True)
    table = compare(models, found)
    assert len(table) == 7
    assert [row.elpd for row in table] == sorted((row.elpd for row in table), reverse=True)
    assert table[0].difference == table[0].error == 0.0
    assert all(table[0].elpd - row.elpd == pytest.approx(row.difference) for row in table)
    assert sum(row.weight for row in table) == pytest.approx(1.0)
    status = {row.effects: row.status for row in table}
    assert status[("a",)] == "chosen"
    assert status[("a", "b")] == "larger than needed"
    assert status[()] == status[("b",)] == "predicts worse"
    (chosen,) = (row for row in table if row.status == "chosen")
    assert chosen.parameters == {"a.size": pytest.approx(0.05, abs=0.005)}
