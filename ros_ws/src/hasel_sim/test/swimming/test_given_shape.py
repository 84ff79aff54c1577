# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Swimmers of given shape against closed forms of swimming theory."""

import numpy as np
import pytest
from hasel_sim.effects.base import Surroundings
from hasel_sim.effects.registry import find_effects
from hasel_sim.effects.slender import finite_length_factor
from hasel_sim.swimming.given_shape import Shape, Swimmer, out_of_balance, swim

LENGTH, DEPTH, DENSITY = 0.2, 0.05, 920.0
FLUID = Surroundings(DENSITY, 0.07, DEPTH, LENGTH)
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(96)
PLACES = np.append(0.5 * LENGTH * (1 + POINTS), LENGTH)
LENGTHS = np.append(0.5 * LENGTH * WEIGHTS, 0.0)
MASS_PER_LENGTH = 13.5


def travelling(amplitude: float, waves: float, frequency: float, standing: float = 0.0):
    """y = b sin(k x - omega t) towards the tail, less a share of the wave that comes back."""
    k, omega = 2 * np.pi * waves / LENGTH, 2 * np.pi * frequency
    x = PLACES

    def shape(time: float) -> Shape:
        y, v, a, slope, turn = (np.zeros((len(x), 2)) for _ in range(5))
        y[:, 0], slope[:, 0] = x, 1.0
        for size, way in ((amplitude, 1.0), (standing * amplitude, -1.0)):
            phase = k * x - way * omega * time
            y[:, 1] += size * np.sin(phase)
            v[:, 1] -= way * omega * size * np.cos(phase)
            a[:, 1] -= omega**2 * size * np.sin(phase)
            slope[:, 1] += k * size * np.cos(phase)
            turn[:, 1] += way * k * omega * size * np.sin(phase)
        return Shape(y, v, a, slope, turn)

    return shape


def rigid(time: float) -> Shape:
    """A straight body."""
    nothing = np.zeros((len(PLACES), 2))
    place, along = nothing.copy(), nothing.copy()
    place[:, 0], along[:, 0] = PLACES, 1.0
    return Shape(place, nothing, nothing, along, nothing)


def swimmer(shape, mass=MASS_PER_LENGTH, **effects) -> Swimmer:
    """One of given shape, with effects by id and their values."""
    found = [(find_effects((name,))[0], values) for name, values in effects.items()]
    return Swimmer(LENGTHS, mass * LENGTHS, shape, found, FLUID)


def speed(shape, periods: int, frequency: float, held=(1, 2), mass=1e-3, **effects) -> float:
    """Mean speed [m/s] forwards (towards the nose, to -x) over the last period."""
    times = np.linspace(0.0, periods / frequency, 40 * periods + 1)
    way = swim(swimmer(shape, mass, **effects), times, held=held)
    return float(-way.mean_velocity(times[-41], times[-1])[0])


@pytest.mark.parametrize(("across", "along"), [(2.0, 1.0), (8.0, 4.0), (12.0, 4.0)])
def test_slow_wave_swims_as_gray_and_hancock_say(across, along):
    """U / V = (C - 1) s / (1 + C s) with s = mean square slope: C = 2 is Taylor's sheet, U = 1/2 omega k b^2."""
    frequency, amplitude, waves = 1.0, 0.0008, 4
    k = 2 * np.pi * waves / LENGTH
    found = speed(
        travelling(amplitude, waves, frequency), 4, frequency, viscous_drag={"across": across, "along": along}
    )
    wave_speed, slope, ratio = 2 * np.pi * frequency / k, 0.5 * (k * amplitude) ** 2, across / along
    assert found == pytest.approx(wave_speed * (ratio - 1) * slope / (1 + ratio * slope), rel=0.015)
    if ratio == 2.0:
        assert found == pytest.approx(0.5 * 2 * np.pi * frequency * k * amplitude**2, rel=0.03)


def test_speed_of_a_slow_wave_does_not_depend_on_viscosity():
    """Only the ratio of the two resistances counts where inertia does not."""
    shape = travelling(0.002, 2, 1.0)
    thin, thick = (
        speed(shape, 4, 1.0, viscous_drag={"across": 2 * size, "along": size}) for size in (4.0, 40.0)
    )
    assert thin == pytest.approx(thick, rel=2e-3)


def test_a_standing_wave_without_inertia_goes_nowhere():
    """What it gains in half a period it loses in the other: Purcell's scallop theorem."""
    effects = {
        "viscous_drag": {"across": 8.0, "along": 4.0},
        "normal_drag": {"coefficient": 2.0, "boundary_layer": 4.0},
    }
    wave = speed(travelling(0.004, 1, 1.0), 3, 1.0, **effects)
    standing = speed(travelling(0.004, 1, 1.0, standing=1.0), 3, 1.0, **effects)
    assert wave > 1e-3
    assert abs(standing) < 0.01 * wave


def test_a_viscous_glide_decays_exponentially():
    """m dU/dt = -mu K_t U / H."""
    drag = 4.0
    times = np.linspace(0.0, 10.0, 101)
    way = swim(swimmer(rigid, viscous_drag={"along": drag}), times, (-0.2, 0.0))
    rate = FLUID.viscosity * drag / DEPTH / MASS_PER_LENGTH
    assert -way.velocity[:, 0] == pytest.approx(0.2 * np.exp(-rate * times), rel=1e-4)
    assert np.abs(way.velocity[:, 1]).max() < 1e-12


def test_a_sideways_glide_against_pressure_decays_hyperbolically():
    """m dU/dt = -1/2 rho C_d U^2, with the added mass of the fluid in m: 1/U grows linearly."""
    drag = 2.0
    times = np.linspace(0.0, 2.0, 41)
    way = swim(
        swimmer(rigid, normal_drag={"coefficient": drag}, reactive_force={"coefficient": 1.0}), times, (0.0, 0.3),
        held=(0, 2),
    )  # fmt: skip
    mass = MASS_PER_LENGTH + DENSITY * np.pi * DEPTH / 4
    assert 1 / way.velocity[:, 1] == pytest.approx(1 / 0.3 + 0.5 * DENSITY * drag / mass * times, rel=1e-4)


def test_a_plate_that_sheds_nothing_tumbles_for_ever():
    """Kirchhoff: the moment of its drift turns it round, and the energy of body and fluid together stays."""
    times = np.linspace(0.0, 4.0, 2001)
    body = swimmer(rigid, finite_depth_added_mass={"coefficient": 1.0})
    way = swim(body, times, (-0.2, 0.05), tolerance=1e-9)
    spin = np.gradient(way.turned, times, edge_order=2)
    along, across = np.cos(way.turned), np.sin(way.turned)
    u = way.velocity[:, 0] * along + way.velocity[:, 1] * across
    w = (way.velocity[:, 1] * along - way.velocity[:, 0] * across)[:, None] + spin[:, None] * PLACES
    fluid = DENSITY * np.pi * DEPTH / 4 * finite_length_factor(FLUID)
    energy = 0.5 * (MASS_PER_LENGTH * (u[:, None] ** 2 + w**2) + fluid * w**2) @ LENGTHS
    assert np.abs(way.turned).max() > 1.0
    assert energy[1:-1] == pytest.approx(energy[1], rel=1e-3)


def test_a_glide_along_a_blasius_layer_ends_with_its_law():
    """At a high Reynolds number the drag is that of both sides of a plate, 1.328 rho U^2 L / sqrt(Re)."""
    thin = Surroundings(998.0, 1e-6, DEPTH, LENGTH)
    body = Swimmer(
        LENGTHS,
        MASS_PER_LENGTH * LENGTHS,
        rigid,
        [(find_effects(("skin_friction",))[0], {"along": 1.0})],
        thin,
    )
    state = np.array([0.0, 0.0, 0.0, -1.0, 0.0, 0.0])
    drag = out_of_balance(body, 0.0, state, np.zeros(3))[0]
    reynolds = 998.0 * LENGTH / 1e-6
    assert -drag == pytest.approx(1.328 * 998.0 * LENGTH / np.sqrt(reynolds), rel=2e-3)


def test_thrust_of_a_small_wave_is_that_of_lighthill():
    """Mean thrust = 1/2 m (mean of h_t^2 - U^2 h_x^2 at the tail) for a wave that is held at a speed."""
    frequency, amplitude, waves, forward = 2.0, 0.001, 1.25, 0.2
    shape = travelling(amplitude, waves, frequency)
    body = swimmer(shape, mass=0.0, reactive_force={"coefficient": 1.0})
    state = np.array([0.0, 0.0, 0.0, -forward, 0.0, 0.0])
    times = np.linspace(0.0, 1 / frequency, 64, endpoint=False)
    thrust = np.mean([out_of_balance(body, t, state, np.zeros(3))[0] for t in times])
    k, omega = 2 * np.pi * waves / LENGTH, 2 * np.pi * frequency
    mass = DENSITY * np.pi * DEPTH / 4
    expected = 0.5 * mass * 0.5 * amplitude**2 * (omega**2 - forward**2 * k**2)
    assert thrust == pytest.approx(expected, rel=5e-3)


def test_the_fluids_momentum_balances_at_large_amplitude():
    """Force on the body = -d/dt of the fluid's momentum + what is shed at the tail, whatever the motion."""
    shape = travelling(0.02, 1.0, 1.5, standing=0.3)
    body = swimmer(shape, mass=0.0, reactive_force={"coefficient": 1.0})
    state = np.array([0.0, 0.0, 0.3, -0.12, 0.05, 0.7])
    acceleration = np.array([0.4, -0.2, 1.5])
    mass = DENSITY * np.pi * DEPTH / 4

    def motion(after: float) -> tuple[np.ndarray, ...]:
        """u, w, t, n of the line a moment later, the frame having moved on."""
        moved = shape(0.2 + after)
        turn = state[2] + state[5] * after + 0.5 * acceleration[2] * after**2
        spin = state[5] + acceleration[2] * after
        to_world = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
        arm, slip, tangent = moved.position @ to_world, moved.velocity @ to_world, moved.tangent @ to_world
        velocity = state[3:5] + acceleration[:2] * after + spin * np.stack([-arm[:, 1], arm[:, 0]], 1) + slip
        tangent = tangent / np.linalg.norm(tangent, axis=1)[:, None]
        across = np.stack([tangent[:, 1], -tangent[:, 0]], axis=1)
        return np.sum(velocity * tangent, 1), np.sum(velocity * across, 1), tangent, across

    def momentum(after: float) -> np.ndarray:
        _, w, _, n = motion(after)
        return mass * (LENGTHS * w) @ n

    step = 1e-5
    u, w, t, n = (part[-1] for part in motion(0.0))
    expected = -(momentum(step) - momentum(-step)) / (2 * step) + mass * (u * w * n - 0.5 * w**2 * t)
    found = -out_of_balance(body, 0.2, state, acceleration)[:2]
    assert found == pytest.approx(expected, rel=1e-5)


def test_the_way_turns_with_the_body():
    """A swimmer that sets out in another direction goes the same way, turned."""
    effects = {
        "normal_drag": {"coefficient": 2.0, "boundary_layer": 4.0},
        "skin_friction": {"along": 1.0, "thinning": 2.7},
        "reactive_force": {"coefficient": 1.0},
    }
    shape = travelling(0.01, 0.8, 2.0)
    times = np.linspace(0.0, 0.5, 21)

    def turned(time: float) -> Shape:
        there = np.array([[0.0, 1.0], [-1.0, 0.0]])
        parts = vars(shape(time)).values()
        return Shape(*(part @ there for part in parts))

    straight, across = (swim(swimmer(s, **effects), times) for s in (shape, turned))
    expected = straight.place @ np.array([[0.0, 1.0], [-1.0, 0.0]])
    assert np.abs(straight.place).max() > 2e-3
    assert across.place == pytest.approx(expected, abs=1e-6)
