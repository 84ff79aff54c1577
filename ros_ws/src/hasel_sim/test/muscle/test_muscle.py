# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A muscle of several pouches on its bench: hanging loads, held lengths, and what its effects change."""

import numpy as np
import pytest
from hasel_sim.errors import ModelError
from hasel_sim.model.muscle_file import load_muscle
from hasel_sim.muscle.muscle import Muscle
from numpy.testing import assert_allclose
from scipy.optimize import brentq


@pytest.fixture
def muscle(pouch):
    """Six of these pouches in series."""
    return Muscle("made up", pouch, 6)


def steady(muscle, voltage, load):
    """Contraction [m] at single voltages and loads, each long after the last."""
    voltage, load = np.atleast_1d(voltage).astype(float), np.atleast_1d(load).astype(float)
    return muscle.contraction(1e6 * np.arange(len(voltage)), voltage, np.broadcast_to(load, voltage.shape))


def test_pouches_in_series_add_up(muscle, pouch):
    """Six pouches contract six times as far as one, under the same force."""
    one = pouch.contraction(pouch.angle_under_load(np.array(5000.0), np.array(0.5)))
    assert_allclose(steady(muscle, 5000.0, 0.5), 6 * one, rtol=1e-12)


def test_polarity_does_not_matter(muscle):
    """The force goes with the square of the voltage."""
    assert_allclose(
        steady(muscle, [4000.0, -4000.0], 0.5)[0], steady(muscle, [4000.0, -4000.0], 0.5)[1], rtol=0
    )


def test_half_of_its_own_weight_hangs_from_a_muscle(pouch):
    """A muscle of 20 g under 0.5 N contracts like one without mass under 0.5 N and 10 g."""
    heavy, light = Muscle("heavy", pouch, 6, mass=0.020), Muscle("light", pouch, 6)
    assert_allclose(steady(heavy, 5000.0, 0.5), steady(light, 5000.0, 0.5 + 0.010 * 9.81), rtol=1e-12)


def test_spring_beside_the_pouches(muscle, pouch):
    """With parallel stiffness the balance is that which a scalar root finder gives."""
    stiff = muscle.with_effects("parallel_stiffness").with_values({"parallel_stiffness.stiffness": 8.0})

    def surplus(angle):
        strain = float(pouch.contraction(np.array(angle))) / pouch.relaxed_length
        return float(pouch.force(6000.0, angle)) - 0.4 - 8.0 * strain

    root = brentq(surplus, pouch.relaxed_angle, np.pi / 2, xtol=1e-14)
    assert_allclose(steady(stiff, 6000.0, 0.4), 6 * pouch.contraction(np.array(root)), rtol=1e-9)


@pytest.mark.parametrize(
    "values",
    [
        {},
        {"parallel_stiffness.stiffness": 8.0},
        {"series_compliance.compliance": 1e-4, "pouch_spread.spread": 0.2},
        {"film_creep.share": 0.1, "film_creep.time": 3.0},
    ],
)
def test_held_and_hanging_are_the_same_law(muscle, values):
    """Held at the contraction that it reaches under a load, the muscle pulls with that load."""
    for effect in dict.fromkeys(name.partition(".")[0] for name in values):
        muscle = muscle.with_effects(effect)
    muscle = muscle.with_values(values)
    time = 0.5 * np.arange(40)
    voltage = np.where(time < 10, 4000.0, 6000.0)
    x = muscle.contraction(time, voltage, np.full(40, 0.5), rest_load=0.0)
    assert_allclose(muscle.force(time, voltage, x), 0.5, rtol=1e-6)


def test_slack_muscle_pulls_with_nothing(muscle):
    """Without voltage, or held shorter than it can get, a muscle gives no force."""
    assert_allclose(
        muscle.force(np.array([0.0, 1.0]), np.array([0.0, 3000.0]), np.array([0.005, 0.5])), 0, atol=1e-9
    )


def test_unknown_effects_and_values_are_refused(muscle):
    """Unknown names are answered with the nearest known one; an effect twice is refused."""
    with pytest.raises(ModelError, match="'edge_effect'"):
        muscle.with_effects("edge_efect")
    with pytest.raises(ModelError, match="'pouch_spread' is in muscle 'made up' already"):
        muscle.with_effects("pouch_spread").with_effects("pouch_spread")
    with pytest.raises(ModelError, match="no parameter"):
        muscle.with_values({"fil": 1.0})


def test_errors_of_its_parameters_keep_their_covariance():
    """As of a body's model; what is held is not free."""
    muscle = load_muscle("peano_hasel")
    names, covariance = muscle.free, np.array([[4e-4, 1e-4], [1e-4, 9e-4]])
    fitted = muscle.with_covariance(names, covariance)
    assert_allclose(fitted.covariance(names), covariance, rtol=1e-5)
    assert fitted.with_held(names[0]).free == names[1:]
