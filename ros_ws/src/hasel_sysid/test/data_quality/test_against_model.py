# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Faults that only a prediction reveals, and physics that must not be taken for one."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_sysid.data_quality import Severity, check_against_model


def _simulated(recording, angle, **properties):
    return angle(recording.time_s, 2.0, **properties)


def _faults(recording, simulated):
    return [finding.fault for finding in check_against_model(recording, simulated)]


def test_matching_model_says_nothing(made_recording, angle):
    """A model that is right raises no finding in 20 runs."""
    for seed in range(20):
        recording = made_recording(seed=seed)
        assert _faults(recording, _simulated(recording, angle)) == []


def test_sign_flip(made_recording, angle):
    """An angle that mirrors the prediction is a flip, not physics."""
    recording = made_recording()
    found = check_against_model(
        replace(recording, sin_theta=-recording.sin_theta), _simulated(recording, angle)
    )
    assert [f.fault for f in found] == ["sign flip or swapped channels"]
    assert found[0].number == pytest.approx(-1, abs=0.01)


def test_degrees(made_recording, angle):
    """A small angle in degrees is 57 times the predicted sine."""
    recording = made_recording()
    degrees = replace(recording, sin_theta=np.degrees(np.arcsin(recording.sin_theta)) / 100)
    assert _faults(degrees, _simulated(recording, angle) / 100) == ["unit of the angle"]


@pytest.mark.parametrize(
    ("shift_s", "severity"), [(0.004 + 1 / 240, "warning"), (-0.02, "error"), (0.115, "error")]
)
def test_lag_of_the_clocks(made_recording, angle, shift_s, severity):
    """A pure shift is named with its size to a fraction of a frame; one against causality is an error."""
    recording = made_recording()
    noise = recording.sin_theta - _simulated(recording, angle)
    shifted = np.interp(recording.time_s - shift_s, recording.time_s, _simulated(recording, angle)) + noise
    found = check_against_model(replace(recording, sin_theta=shifted), _simulated(recording, angle))
    assert [f.fault for f in found] == ["command lag"]
    assert found[0].number == pytest.approx(shift_s, abs=0.002)
    assert found[0].severity is Severity(severity)


def test_damping_is_no_lag_of_the_clocks(made_recording, angle):
    """A body damped twice as much lags too, but not by a pure shift."""
    recording = made_recording()
    assert _faults(recording, _simulated(recording, angle, damping_ratio=0.3)) == []
    assert _faults(recording, _simulated(recording, angle, natural_hz=3.0)) == []


def test_lag_of_one_channel(made_recording, angle):
    """Where only answers to the lower channel come late, the channels are told apart."""
    recording = made_recording()
    simulated = _simulated(recording, angle)
    lower = np.mod(2 * recording.time_s, 1) >= 0.5
    late = np.interp(recording.time_s - 0.02 * lower, recording.time_s, simulated)
    measured = late + recording.sin_theta - simulated
    found = check_against_model(replace(recording, sin_theta=measured), simulated)
    assert [f.fault for f in found] == ["channel lag"]
    assert found[0].number == pytest.approx(-0.02, abs=0.004)


def test_recorded_simulation(made_recording, angle):
    """A measurement that is the simulation itself is noticed."""
    recording = made_recording()
    simulated = _simulated(recording, angle)
    assert _faults(replace(recording, sin_theta=simulated), simulated) == ["simulation equals measurement"]


def test_head_and_tail_by_their_distances(made_recording, angle):
    """Markers whose distances are the model's in reverse are exchanged; millimetres are named too."""
    recording = made_recording()
    frames = np.ones((len(recording.time_s), 1, 1))
    markers = frames * np.array([[0.005, 0.0], [0.080, 0.0], [0.190, 0.0]])
    reverse = frames * np.array([[0.190, 0.0], [0.080, 0.0], [0.005, 0.0]])
    simulated = _simulated(recording, angle)

    def faults(own):
        found = check_against_model(replace(recording, markers=own), simulated, markers)
        return [finding.fault for finding in found]

    assert faults(reverse) == ["marker swap"]
    assert faults(1e3 * markers) == ["unit of the markers"]
    assert faults(markers) == []
