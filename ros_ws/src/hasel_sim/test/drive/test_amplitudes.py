# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The seed paper's muscle: amplitude per voltage, one slope."""

import numpy as np
import pytest
from hasel_sim.drive.amplitudes import PiecewisePower, limit_rate, target_contraction

LEVELS, AMPLITUDES = np.array([3500.0, 4500.0, 5500.0]), np.array([0.02, 0.05, 0.06])


def test_the_target_passes_through_the_amplitudes_of_either_sign():
    """Exact at the levels and at zero, the same for negative voltages."""
    found = target_contraction(np.array([0.0, 3500.0, -4500.0, 5500.0]), LEVELS, AMPLITUDES)
    assert found == pytest.approx([0.0, 0.02, 0.05, 0.06])


def test_the_target_rises_monotonically_between_and_beyond_the_levels():
    """PCHIP overshoots nowhere; above the highest level it goes on."""
    found = target_contraction(np.linspace(0, 7000, 400), LEVELS, AMPLITUDES)
    assert np.all(np.diff(found) >= 0)
    assert found[-1] >= 0.06


@pytest.mark.parametrize("onset", [0.0, 800.0, 2800.0])
@pytest.mark.parametrize("count", [1, 2, 3])
@pytest.mark.parametrize("between", ["cubic", "power"])
def test_below_the_lowest_level_the_curve_goes_on_as_steeply_down_to_the_onset(onset, count, between):
    """Nothing up to the onset, the known amplitude at the level, no corner there, and no way back in between."""

    def curve(voltage):
        return target_contraction(np.asarray(voltage), LEVELS[:count], AMPLITUDES[:count], onset, between)

    below = np.linspace(onset, 3500, 200)
    assert not curve(np.linspace(0, onset, 20)).any()
    assert curve([3500.0]) == pytest.approx(AMPLITUDES[:1])
    assert np.all(np.diff(curve(below)) > 0)
    steepness = np.diff(curve([3499.9, 3500.0, 3500.1])) / 0.1
    assert steepness[0] == pytest.approx(steepness[1], rel=1e-3)


def test_a_power_of_the_voltage_is_met_below_its_levels():
    """Of amplitudes that are V^2.4 a piecewise power knows the rest, wherever it is; a cubic to 3 % of the lowest."""
    amplitudes = 0.02 * (LEVELS / 3500) ** 2.4
    voltage = np.linspace(100, 6000, 60)
    expected = 0.02 * (voltage / 3500) ** 2.4
    powers = target_contraction(voltage, LEVELS, amplitudes, between="power")
    assert powers[voltage < 5500] == pytest.approx(expected[voltage < 5500])
    cubic = target_contraction(voltage, LEVELS, amplitudes)
    assert np.abs(cubic - expected)[voltage < 5500].max() < 0.03 * 0.02


def test_the_slope_of_a_piecewise_power_is_that_of_its_curve():
    """In the middle of each piece, by a difference."""
    curve = PiecewisePower(LEVELS, AMPLITUDES)
    for level in (4000.0, 5000.0):
        difference = (curve(level + 1e-3) - curve(level - 1e-3)) / 2e-3
        assert float(curve(level, 1)) == pytest.approx(float(difference), rel=1e-6)


def test_without_levels_nothing_contracts():
    """A model that has seen no voltage yet."""
    assert not target_contraction(np.array([1000.0]), np.array([]), np.array([])).any()


def test_the_contraction_is_a_box_with_sloped_sides():
    """Rises and falls at the slope, holds at the amplitude; each muscle by itself."""
    time = np.linspace(0, 1, 1001)
    target = np.stack([np.where(time < 0.5995, 0.06, 0.0), np.where(time < 0.5995, 0.0, 0.06)], axis=1)
    found = limit_rate(time, target, 0.3)
    after = time - 0.599
    expected = np.where(time < 0.5995, np.minimum(0.3 * time, 0.06), np.maximum(0.06 - 0.3 * after, 0.0))
    assert found[:, 0] == pytest.approx(expected, abs=1e-9)
    assert found[:, 1] == pytest.approx(np.where(time < 0.5995, 0.0, np.minimum(0.3 * after, 0.06)), abs=1e-9)


def test_a_slope_too_low_for_the_frequency_gives_a_triangle():
    """The amplitude is never reached; the contraction stays continuous."""
    time = np.linspace(0, 1, 1001)
    found = limit_rate(time, np.where(time < 0.5, 1.0, 0.0)[:, None].repeat(2, 1), 0.1)
    assert found.max() == pytest.approx(0.05, abs=1e-3)
    assert np.abs(np.diff(found, axis=0)).max() <= 0.1 * 1e-3 + 1e-12


def test_a_target_met_between_two_instants_is_followed_from_there():
    """Falling at the slope, meeting a target that rises steeply, and rising at the slope: the valley is exact."""
    time, target = np.array([0.0, 1.0, 1.0, 2.0]), np.array([0.1, 0.1, 0.0, 1.0])[:, None]
    found = limit_rate(time, target, 0.1)
    # down from 0.1 at 1 s until 1 s + 1/11 s, where the target is 1/11, and up again
    assert found[:, 0] == pytest.approx([0.0, 0.1, 0.1, 1 / 11 + 0.1 * 10 / 11])


@pytest.mark.parametrize("steepness", [-0.2, -0.05, 0.05, 0.2])
@pytest.mark.parametrize("gap", [-0.02, 0.0, 0.02])
def test_agrees_with_small_steps(steepness, gap):
    """From above, on, or below a steadily moving target: the end is that of ten thousand small steps."""
    ends = []
    for count in (2, 10001):
        time = np.concatenate([[0.0, 1.0], np.linspace(1.0, 1.5, count)])
        target = np.concatenate([[0.05, 0.05], 0.05 + gap + steepness * (time[2:] - 1.0)])
        ends.append(limit_rate(time, target[:, None], 0.1)[-1, 0])
    assert ends[0] == pytest.approx(ends[1], abs=2e-5)
