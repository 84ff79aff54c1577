# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The pouch against closed forms, and against quadrature and root finding that share no code with it."""

import numpy as np
import pytest
from hasel_sim.errors import ModelError
from hasel_sim.muscle.pouch import VACUUM_PERMITTIVITY, Pouch
from numpy.testing import assert_allclose
from scipy.integrate import quad
from scipy.optimize import brentq


def angles(pouch: Pouch, count: int = 9) -> np.ndarray:
    """Half angles strictly inside the stroke."""
    return np.linspace(pouch.relaxed_angle, pouch.largest_angle, count + 2)[1:-1]


def test_relaxed_pouch_holds_the_liquid(pouch):
    """Without voltage all of the film is free, and two circular segments over it hold the liquid."""
    radius = pouch.film_length / (2 * pouch.relaxed_angle)
    edge = radius * np.cos(pouch.relaxed_angle)
    half_chord = radius * np.sin(pouch.relaxed_angle)
    bulge, _ = quad(lambda x: np.sqrt(radius**2 - x**2) - edge, -half_chord, half_chord)
    assert_allclose(2 * bulge, pouch.area, rtol=1e-9)


def test_full_zip_is_a_cylinder(pouch):
    """With fill 1 zipping ends at a cylinder whose circumference is the film left free."""
    assert pouch.largest_angle == np.pi / 2
    free = pouch.film_length - pouch.electrode_length
    assert_allclose(pouch.zipped(np.array(np.pi / 2)), pouch.electrode_length, rtol=1e-12)
    assert_allclose(np.pi * (free / np.pi) ** 2, pouch.area, rtol=1e-12)


def test_free_stroke_is_geometry(pouch):
    """The seals end as far apart as the zipped film and the cylinder's diameter."""
    free = pouch.film_length - pouch.electrode_length
    left = pouch.electrode_length + 2 * free / np.pi
    assert_allclose(pouch.largest_contraction, pouch.relaxed_length - left, rtol=1e-9)


def test_little_liquid_zips_to_the_end_of_the_electrode():
    """With less liquid the electrode is zipped before the free part is a cylinder."""
    pouch = Pouch(0.020, 0.010, 0.050, 18e-6, 3.15, fill=0.6)
    assert pouch.relaxed_angle < pouch.largest_angle < np.pi / 2
    assert_allclose(pouch.zipped(np.array(pouch.largest_angle)), pouch.electrode_length, rtol=1e-9)


def test_blocking_force(pouch):
    """At zero strain the force is (eps w V^2 / 4 t) cos alpha_0 / (1 - cos alpha_0)."""
    voltage, cosine = 5000.0, np.cos(pouch.relaxed_angle)
    expected = VACUUM_PERMITTIVITY * 3.15 * 0.050 * voltage**2 / (4 * 18e-6) * cosine / (1 - cosine)
    assert_allclose(pouch.force(voltage, pouch.relaxed_angle), expected, rtol=1e-12)


def test_a_cylinder_does_not_pull(pouch):
    """The force is gone when the free part is a cylinder."""
    assert_allclose(pouch.force(8000.0, np.pi / 2), 0.0, atol=1e-12)


@pytest.mark.parametrize("fill", [0.6, 1.0, 1.6])
def test_force_is_virtual_work(fill):
    """F dx = V^2 dC / 2, by finite differences of contraction and capacitance."""
    pouch = Pouch(0.020, 0.010, 0.050, 18e-6, 3.15, fill=fill)
    at, step, voltage = angles(pouch), 1e-5, 6000.0
    work = 0.5 * voltage**2 * (pouch.capacitance(at + step) - pouch.capacitance(at - step))
    way = pouch.contraction(at + step) - pouch.contraction(at - step)
    assert_allclose(pouch.force(voltage, at), work / way, rtol=1e-6)


def test_work_of_a_stroke_is_the_energy_of_the_capacitor(pouch):
    """The area under the force-stroke curve is half V^2 times the change of capacitance (quadrature)."""
    voltage = 6000.0
    start = 1.001 * pouch.relaxed_angle

    def power(angle: float) -> float:
        step = 1e-6
        slope = (pouch.contraction(np.array(angle + step)) - pouch.contraction(np.array(angle - step))) / (
            2 * step
        )
        return float(pouch.force(voltage, angle) * slope)

    work, _ = quad(power, start, np.pi / 2 - 1e-6, limit=200)
    capacity = pouch.capacitance(np.array([start, np.pi / 2]))
    assert_allclose(work, 0.5 * voltage**2 * (capacity[1] - capacity[0]), rtol=1e-5)


@pytest.mark.parametrize("load", [0.05, 0.5, 3.0])
def test_stroke_under_load_is_the_minimum_of_energy(pouch, load):
    """Under a hanging load the seals rest where load times height less the co-energy is least (scan and root)."""
    voltage = 6000.0
    found = float(pouch.contraction(pouch.angle_under_load(np.array(voltage), np.array(load))))

    def total(angle):
        return load * pouch.contraction(angle) - 0.5 * voltage**2 * pouch.capacitance(angle)

    scanned = np.linspace(pouch.relaxed_angle, np.pi / 2, 200_001)
    assert_allclose(found, pouch.contraction(scanned[np.argmin(total(scanned))]), rtol=1e-4)
    root = brentq(lambda a: float(pouch.force(voltage, a)) - load, pouch.relaxed_angle, np.pi / 2)
    assert_allclose(found, pouch.contraction(np.array(root)), rtol=1e-9)


def test_too_heavy_a_load_is_not_lifted(pouch):
    """Above the blocking force, and without voltage, nothing contracts."""
    blocked = float(pouch.force(2000.0, pouch.relaxed_angle))
    angle = pouch.angle_under_load(np.array([2000.0, 0.0]), np.array([1.01 * blocked, 0.1]))
    assert_allclose(pouch.contraction(angle), 0.0, atol=1e-12)


def test_impossible_pouches_are_refused():
    """Electrodes longer than the film, and a pouch that is full before it zips, are refused with a sentence."""
    with pytest.raises(ModelError, match="less than the film's length"):
        Pouch(0.010, 0.020, 0.050, 18e-6, 3.15)
    with pytest.raises(ModelError, match=r"below 4, where all of its film is a cylinder"):
        Pouch(0.020, 0.010, 0.050, 18e-6, 3.15, fill=4.1)
