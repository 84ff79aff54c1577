# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Camera latency."""

from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sim.effects.registry import catalogue


@pytest.mark.parametrize("frames", [3, -3])
def test_the_whole_series_moves_in_time(frames, coarse_swimmer, coarse_baseline, sin_theta_of):
    """A latency of three frames shows the angle three frames later; a negative one shows what is yet to come."""
    model = coarse_swimmer.with_effects("camera_latency").with_values(
        {"camera_latency.latency": frames / 120}
    )
    seen = sin_theta_of(model)
    if frames > 0:
        assert seen[frames:] == pytest.approx(coarse_baseline[:-frames], abs=1e-9)
    else:
        assert seen[:frames] == pytest.approx(coarse_baseline[-frames:], abs=1e-9)
        assert np.abs(np.diff(seen[frames - 1 :])).min() > 0


def test_between_two_frames_a_sine_is_followed():
    """A latency that is no multiple of the frame time shifts a sine by its phase."""
    time = np.arange(0.0, 1.0, 1 / 240)
    effect, p = catalogue()["camera_latency"], SimpleNamespace(latency=0.0137)
    found = effect.angle(time, 0.3 * np.sin(2 * np.pi * 3.5 * time), p)
    exact = 0.3 * np.sin(2 * np.pi * 3.5 * (time - 0.0137))
    assert found[5:] == pytest.approx(exact[5:], abs=1e-6)
