"""Which sets of effects a search finds, on linear problems with a known truth and no simulator."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hasel_sysid.noise.model import NoiseModel
from hasel_sysid.selection import POLICY, choose, search
from hasel_sysid.testing.linear_choice import SLOW, WHITE, chosen, made_up
from hasel_sysid.testing.linear_sets import LinearSets, run_numbers, smooth_series


@pytest.mark.parametrize("noise", [WHITE, SLOW], ids=["white", "shared by neighbours"])
@pytest.mark.parametrize("sizes", [{"c": 0.03}, {"c": 0.03, "g": -0.02}, {"a": 0.02, "d": 0.02, "j": 0.03}])
def test_what_is_there_is_chosen(sizes, noise):
    """One, two or three effects, each as large as the noise or smaller, and nothing beside them."""
    for seed in range(2):
        assert chosen(LinearSets(made_up(seed), sizes, noise, seed))[0] == "".join(sorted(sizes))


@pytest.mark.parametrize("noise", [WHITE, SLOW], ids=["white", "shared by neighbours"])
def test_noise_is_taken_for_noise(noise):
    """One in a hundred may be taken for an effect: of thirty no more than two are."""
    false = sum(chosen(LinearSets(made_up(seed), {}, noise, seed))[0] != "" for seed in range(30))
    assert false <= 2


def test_two_that_hide_each_other_are_found_together():
    """Each alone looks like a third one, which is nearly their difference: adding one by one would begin with that."""
    for seed in range(3):
        series = made_up(seed)
        series["b"] = series["a"] + 0.3 * series["b"]
        series["c"] = (series["b"] - series["a"]) / 0.3 + 0.25 * series["c"]
        assert chosen(LinearSets(series, {"a": -0.2, "b": 0.2}, WHITE, seed))[0] in ("ab", "c")
        assert chosen(LinearSets(series, {"a": -0.2, "b": 0.25}, WHITE, seed))[0] == "ab"


def test_what_only_stood_in_for_two_others_goes():
    """The likeliest single effect is a mixture of the two that are there."""
    for seed in range(3):
        series = made_up(seed)
        series["c"] = series["a"] + series["b"] + 0.5 * series["c"]
        assert chosen(LinearSets(series, {"a": 0.05, "b": 0.04}, WHITE, seed))[0] == "ab"


def test_while_much_is_missing_it_is_squares_that_are_compared():
    """A slow swing is a hundred times the power of a fast one, which noise that is slow as well shows more clearly."""
    time = np.tile(np.arange(80) / 120.0, 8)
    series = {"a": np.sin(2 * np.pi * 0.8 * time + 0.5), "b": np.sin(2 * np.pi * 20.0 * time)}
    noise = NoiseModel(1e-6, 0.05**2, 0.99)
    sets = LinearSets(series, {"a": 1.0, "b": 0.1}, noise)
    found = search(sets, replace(POLICY, most_effects=1))
    assert choose(found, POLICY).chosen == {"a"}
    assert chosen(sets)[0] == "ab"


def test_the_declared_discrepancy_excuses_no_more_than_its_size():
    """A drift of many times its rms is an effect, though it is slow as the discrepancy is, and what is fast is left."""
    runs = run_numbers(1, 480)
    time = np.arange(480) / 120.0
    series = {"a": np.exp(-time / 2.0), "b": np.exp(-time / 0.5) * np.sin(2 * np.pi * 40.0 * time)}
    quiet = NoiseModel(2e-5**2, 0.0, 0.5)
    sets = LinearSets(series, {"a": 0.06, "b": 0.01}, quiet, runs=runs, swing=0.3)
    found = search(sets, replace(POLICY, most_effects=1))
    assert choose(found, POLICY).chosen == {"a"}


def test_what_cannot_matter_is_not_fitted():
    """A second effect that surely is there, and would take away less than a larger set must."""
    seen = 0
    for seed in range(3):
        _, choice, found = chosen(LinearSets(made_up(seed), {"a": 0.05, "b": 0.006}, WHITE, seed))
        assert choice.chosen == {"a"}
        assert max(map(len, found.known)) == 1
        seen += found.last.chance < POLICY.level
    assert seen >= 2


def test_effects_that_exclude_each_other_are_never_together():
    """The best that can be had is one of them."""
    sets = LinearSets(made_up(2), {"a": 0.05, "b": 0.03}, WHITE, 2, exclusive=[frozenset("ab")])
    _, choice, found = chosen(sets)
    assert not choice.chosen >= {"a", "b"}
    assert not any(effects >= {"a", "b"} for effects in found.known)


def test_no_more_than_three():
    """Four are there: more effects than that could imitate anything."""
    found = search(LinearSets(made_up(4), dict.fromkeys("abcd", 0.05), WHITE, 4), POLICY)
    assert max(map(len, found.known)) == POLICY.most_effects
    assert found.last.chance < POLICY.level


def test_a_stranger_leaves_something_missing():
    """Whatever imitates a part of it, the last test still says that something is missing."""
    stranger = 0.1 * smooth_series(np.random.default_rng(99), run_numbers())
    series = made_up(5)
    series["a"] = series["a"] + 6.0 * stranger
    _, _, found = chosen(LinearSets(series, {}, WHITE, 5, stranger=stranger))
    assert found.first.chance < POLICY.level


def test_what_one_run_alone_asks_for_is_not_added():
    """A disturbance of a single run looks like an effect there, and the other runs know nothing of it."""
    for seed in range(3):
        series = made_up(seed)
        runs = run_numbers()
        disturbed = np.where(runs == 3, 0.08 * series["a"], 0.0)
        assert chosen(LinearSets(series, {}, WHITE, seed, stranger=disturbed))[0] == ""


def test_one_run_is_judged_by_its_parts():
    """Nothing else can be left out of it."""
    runs = run_numbers(1, 480)
    name, _, found = chosen(LinearSets(made_up(6, runs=runs), {"b": 0.05}, WHITE, 6, runs=runs))
    assert name == "b"
    assert len(found.worths[frozenset("b")].densities) == 4


def test_a_search_out_of_time_still_answers():
    """With what it has fitted: one set in any case."""
    sets = LinearSets(made_up(7), {"a": 0.05, "b": 0.04, "c": 0.04}, WHITE, 7, most_fits=0)
    _, _, found = chosen(sets)
    assert sets.fits == 1
    assert len(found.known) == 2


def test_a_trifle_is_seen_and_not_added():
    """It takes away a twentieth of the squared error: surely there, and less than what another mesh leaves."""
    seen = 0
    for seed in range(4):
        name, _, found = chosen(LinearSets(made_up(seed), {"a": 0.006}, WHITE, seed))
        assert name == ""
        seen += found.first.chance < POLICY.level
    assert seen >= 2


def test_what_finer_numerics_would_take_away_is_not_to_an_effects_credit():
    """An effect much like the change by a finer mesh is added for what that cannot be, and not for what it may be."""
    for seed in range(3):
        series = made_up(seed)
        mesh = 0.02 * (series["a"] + 0.3 * series["b"])
        assert chosen(LinearSets(series, {"a": 0.015}, WHITE, seed))[0] == "a"
        assert chosen(LinearSets(series, {"a": 0.015}, WHITE, seed, slack=[mesh]))[0] == ""
        assert chosen(LinearSets(series, {"a": 0.2}, WHITE, seed, slack=[mesh]))[0] == "a"


def test_a_search_foresees_which_fits_it_will_ask_for():
    """The likeliest of those that are foreseen is asked for next, and many are foreseen."""
    foreseen = came_true = count = 0
    for seed in range(3):
        sets = LinearSets(made_up(seed), dict(zip("abcd", (0.3, 0.25, 0.2, 0.2), strict=True)), WHITE, seed)
        search(sets, POLICY)
        count += len(sets.asked) - 1
        for (_, likely), (asked, _) in pairwise(sets.asked):
            assert len(set(likely)) == len(likely)
            foreseen += bool(likely)
            came_true += likely[:1] == [asked]
    assert foreseen >= count / 3
    assert came_true >= 0.9 * foreseen
