# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Recordings as experiments."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_recording import HASEL_PAIR, DriveChannel, Recording, RecordingWarning
from hasel_sim.model import load_model
from hasel_sysid.dataset import drive_levels, for_model, matched
from hasel_sysid.errors import SysidError
from hasel_sysid.experiment import experiment_of


def _runs(*levels: float):
    """One run per level, each held for a second."""
    time = np.arange(120) / 120
    return [
        experiment_of(Recording(f"run{level}", time, np.zeros(120), np.tile([level, 0.0], (120, 1))))
        for level in levels
    ]


def test_one_voltage_measured_in_several_runs_has_one_amplitude():
    """3499.6, 3500.2 and 3500.9 V are one level with the roundest number among them; 3600 V is another."""
    np.testing.assert_allclose(drive_levels(_runs(3499.6, 3500.2, 3500.9, 3600.0)), [3500.0, 3600.0])


def test_commanded_levels_stay_as_they_are():
    """Every commanded voltage keeps its own number."""
    np.testing.assert_allclose(drive_levels(_runs(4567.0, 3501.0, 5500.0)), [3501.0, 4567.0, 5500.0])


def test_a_fine_ramp_is_not_one_level():
    """Many levels, each near the next, are spread over their range."""
    assert len(drive_levels(_runs(*np.arange(3000.0, 5500.0, 12.0)))) == 8


THIRD = DriveChannel("third", "voltage", "V")


def with_third(recording, level):
    """The run with a channel more, in front of the others."""
    signal = np.column_stack([np.full(len(recording.time_s), level), recording.voltage])
    return replace(recording, drive_signal=signal, channels=(THIRD, *HASEL_PAIR))


def test_a_channel_at_zero_is_left_out_aloud(made_recording):
    """What never drives anything is dropped once for all runs, with a warning."""
    runs = [with_third(made_recording(seed=seed, name=f"run{seed}"), 0.0) for seed in range(2)]
    with pytest.warns(RecordingWarning, match="'third' is zero throughout in 2 of 2 recordings") as said:
        found = matched(load_model("swimmer"), runs)
    assert len(said) == 1
    assert [run.channels for run in found] == [HASEL_PAIR, HASEL_PAIR]
    assert np.array_equal(found[0].drive_signal, made_recording().voltage)


def test_a_channel_without_a_muscle_is_refused(made_recording):
    """A channel that is driven and contracts nothing is one sentence, with what the model has."""
    with pytest.raises(
        SysidError, match=r"'third' \(voltage_third_v\), which contracts no muscle.*upper \[V\], lower"
    ):
        matched(load_model("swimmer"), [with_third(made_recording(), 10.0)])


def test_a_misspelt_channel_is_refused_with_the_nearest(made_recording):
    """A channel that is nearly one of the model's is most likely meant."""
    channels = (HASEL_PAIR[0], DriveChannel("lowr", "voltage", "V"))
    with pytest.raises(SysidError, match="is 'lower' meant\\? Then rename the column"):
        matched(load_model("swimmer"), [replace(made_recording(), channels=channels)])


def test_a_channel_of_the_model_without_a_column_is_refused(made_recording):
    """The reverse: the model has a channel that was not recorded."""
    recording = made_recording()
    upper = replace(recording, drive_signal=recording.voltage[:, :1], channels=HASEL_PAIR[:1])
    with pytest.raises(
        SysidError, match=r"no column for channel 'lower' of model 'swimmer'.*add voltage_lower_v"
    ):
        matched(load_model("swimmer"), [upper])


def test_a_run_without_a_drive_is_refused_for_a_driven_body(made_recording):
    """Without a drive there is nothing to be said of muscles; a passive body needs none."""
    passive = replace(made_recording(), drive_signal=None)
    with pytest.raises(SysidError, match="has no drive, and model 'swimmer' is driven by upper"):
        matched(load_model("swimmer"), [passive])
    assert matched(load_model("beam"), [passive]) == [passive]


def test_another_quantity_is_refused(made_recording):
    """A pressure is not a voltage, even of the same channel."""
    channels = tuple(DriveChannel(channel.name, "pressure", "Pa") for channel in HASEL_PAIR)
    with pytest.raises(
        SysidError, match="gives a pressure for 'upper', and model 'swimmer' expects a voltage"
    ):
        matched(load_model("swimmer"), [replace(made_recording(), channels=channels)])


def test_a_level_far_beyond_the_fitted_ones_is_refused(made_recording):
    """Between and a little above the fitted levels the model interpolates; far beyond it is not asked."""
    model = load_model("swimmer").with_levels([3500.0, 4500.0])
    inside = [experiment_of(made_recording(voltage=4000.0)), experiment_of(made_recording(voltage=5500.0))]
    assert for_model(model, inside) == inside
    with pytest.raises(
        SysidError, match=r"drives 'upper' with 9000 V, far beyond the levels .*\(3500, 4500 V\)"
    ):
        for_model(model, [experiment_of(made_recording(voltage=9000.0))])


def test_amplitudes_named_in_kilovolts_are_taken_for_that(made_recording):
    """5.5 in a model file and 5500 V in the recording: the sentence says which name was meant."""
    model = load_model("swimmer").with_levels([5.5])
    with pytest.raises(
        SysidError, match=r"knows 5\.5 V: is amplitude_5500 meant where .* says amplitude_5\.5\?"
    ):
        for_model(model, [experiment_of(made_recording(voltage=5500.0))])


def test_more_than_the_model_file_allows_is_refused(made_recording):
    """The limit of a channel is the model file's: 45 kV is most likely a wrong unit."""
    with pytest.raises(
        SysidError, match="with 45000 V, and model 'swimmer' allows 10000 V: is the column in V"
    ):
        for_model(load_model("swimmer"), [experiment_of(made_recording(voltage=45000.0))])


def test_levels_are_those_of_the_channels_own_quantity(made_recording):
    """A pressure is measured against the pressures that the model knows, and said in its unit."""
    channel = (DriveChannel("upper", "pressure", "Pa"),)
    recording = made_recording(voltage=25000.0)
    run = replace(recording, drive_signal=recording.voltage[:, :1], channels=channel)
    model = load_model("arm").with_levels([10000.0, 20000.0])
    assert for_model(model, [experiment_of(run)])[0].recording is run
    with pytest.raises(
        SysidError, match=r"with 25000 Pa, far beyond the levels that model 'arm' knows \(10000 Pa\)"
    ):
        for_model(load_model("arm").with_levels([10000.0]), [experiment_of(run)])
