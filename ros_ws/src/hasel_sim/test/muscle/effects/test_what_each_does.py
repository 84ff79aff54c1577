# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What each effect of the bench changes, against its own closed form."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_sim.muscle.muscle import Muscle
from numpy.testing import assert_allclose

TIME = np.arange(0.0, 40.0, 0.1)


@pytest.fixture
def muscle(pouch):
    """Six of these pouches in series."""
    return Muscle("made up", pouch, 6)


def with_effect(muscle, **values):
    """The muscle with one effect, named by its parameters as effect__parameter."""
    names = {key.replace("__", "."): value for key, value in values.items()}
    return muscle.with_effects(next(iter(names)).partition(".")[0]).with_values(names)


def hung(muscle, voltage, load=0.5):
    """Contraction [m] at TIME under one load."""
    return muscle.contraction(TIME, np.broadcast_to(voltage, TIME.shape), np.full(TIME.shape, load))


def test_edges_take_width(muscle, pouch):
    """A dead strip of 0.3 pouch lengths at each side is a muscle that much narrower."""
    narrower = replace(muscle, pouch=replace(pouch, width=pouch.width - 2 * 0.3 * pouch.film_length))
    assert_allclose(
        hung(with_effect(muscle, edge_effect__strip=0.3), 4000.0), hung(narrower, 4000.0), rtol=1e-12
    )


def test_edges_cost_narrow_pouches_more(muscle, pouch):
    """The share of blocking force that is lost is inverse to the width."""

    def lost(width):
        muscle_of_width = replace(muscle, pouch=replace(pouch, width=width))
        with_edges = with_effect(muscle_of_width, edge_effect__strip=0.2)
        at = (np.zeros(1), np.array([5000.0]), np.zeros(1))
        return 1 - with_edges.force(*at)[0] / muscle_of_width.force(*at)[0]

    assert_allclose(lost(0.02) / lost(0.08), 4.0, rtol=1e-9)


def test_oil_is_a_capacitor_in_series(muscle, pouch):
    """The zipped capacitance is that of film, liquid and film in series."""
    ((_, thicker),) = with_effect(muscle, trapped_oil__gap=6e-6).populations
    oil = 8.8541878128e-12 * 3.0 * pouch.width / 6e-6
    film = pouch.capacitance_per_zipped_length
    assert_allclose(thicker.capacitance_per_zipped_length, film * oil / (film + oil), rtol=1e-12)


def test_spread_softens_the_onset(muscle, pouch):
    """Where equal pouches do not begin to contract yet, some of unequal ones do."""
    threshold = np.sqrt(0.5 / float(pouch.force(1.0, pouch.relaxed_angle)))
    assert hung(muscle, 0.9 * threshold)[-1] < 1e-9
    assert hung(with_effect(muscle, pouch_spread__spread=0.3), 0.9 * threshold)[-1] > 1e-6


def test_stiffening_spares_small_contractions(muscle):
    """Quadratic resistance takes a smaller share of a small contraction than of a large one."""
    stiff = with_effect(muscle, stiffening__stiffness=100.0)
    small, large = (1 - hung(stiff, volts)[-1] / hung(muscle, volts)[-1] for volts in (2000.0, 6000.0))
    assert 0 < small < large


def test_film_stretches_by_hooke(muscle, pouch):
    """A film held so that it does not zip stretches by half the additional force over E t w."""
    heavy = with_effect(muscle, film_elasticity__compliance=4e-10)
    load = np.array([1.0, 1.0, 3.0])
    x = heavy.contraction(np.arange(3.0), np.zeros(3), load)
    strain = (3.0 - 1.0) / 2 * 4e-10 / (pouch.film_thickness * pouch.width)
    assert_allclose(x[2], -6 * strain * pouch.film_length / np.cos(pouch.relaxed_angle), rtol=1e-9)


def test_series_spring_is_blind_to_a_hanging_load(muscle):
    """Under one load nothing is seen of it; held, the muscle pulls less."""
    soft = with_effect(muscle, series_compliance__compliance=2e-4)
    assert_allclose(hung(soft, 5000.0), hung(muscle, 5000.0), rtol=1e-12)
    at = (np.zeros(1), np.array([5000.0]), np.zeros(1))
    force, stiff_force = soft.force(*at)[0], muscle.force(*at)[0]
    expected = muscle.force(np.zeros(1), np.array([5000.0]), np.array([6 * 2e-4 * force]))[0]
    assert force < stiff_force
    assert_allclose(force, expected, rtol=1e-7)


def test_creep_follows_its_exponential(muscle):
    """A held voltage adds g (1 - exp(-t / tau)) of the contraction."""
    crept = hung(with_effect(muscle, film_creep__share=0.2, film_creep__time=8.0), 5000.0)
    assert_allclose(crept / hung(muscle, 5000.0), 1 + 0.2 * -np.expm1(-TIME / 8.0), rtol=1e-9)


def test_flow_settles_exponentially(muscle):
    """After a switch the contraction approaches its balance with the time constant."""
    slow = hung(with_effect(muscle, viscous_flow__time=2.0), 5000.0)
    assert_allclose(slow[1:] / hung(muscle, 5000.0)[1:], -np.expm1(-(TIME[1:]) / 2.0), rtol=0.03)


def test_retained_charge_shields_and_alternating_polarity_frees(muscle):
    """A held voltage loses beta in the end; one that alternates quickly loses nearly nothing."""
    retaining = with_effect(muscle, charge_retention__fraction=0.2, charge_retention__time=2.0)
    assert_allclose(hung(retaining, 5000.0)[-1], hung(muscle, 4000.0)[-1], rtol=1e-6)
    bipolar = 5000.0 * np.where(np.floor(TIME / 0.2) % 2 == 0, 1.0, -1.0)
    assert_allclose(hung(retaining, bipolar)[-1], hung(muscle, 5000.0)[-1], rtol=0.02)


def test_hysteresis_opens_a_loop(muscle):
    """On a slow triangle the way down lies above the way up, as if the voltage were 2 w higher."""
    triangle = 6000.0 * (1 - np.abs(TIME - 20.0) / 20.0)
    x = hung(with_effect(muscle, zipping_hysteresis__width=400.0), triangle)
    up, down = np.searchsorted(TIME, 10.0), np.searchsorted(TIME, 30.0)
    assert_allclose(x[up], hung(muscle, triangle[up] - 400.0)[0], rtol=1e-6)
    assert_allclose(x[down], hung(muscle, triangle[down] + 400.0)[0], rtol=1e-6)
