# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import math

import pytest
from hasel_recording import HASEL_PAIR, DriveChannel, RecordingError, parse_column, read_recording
from hasel_recording.drive_channel import SI_UNITS, UNITS, is_drive_column


@pytest.mark.parametrize(
    ("column", "channel", "factor"),
    [
        ("voltage_upper_v", DriveChannel("upper", "voltage", "V"), 1.0),
        ("Voltage_upper_kV", DriveChannel("upper", "voltage", "V"), 1000.0),
        ("pressure_chamber_mbar", DriveChannel("chamber", "pressure", "Pa"), 100.0),
        (
            "pressure_left_front_psi",
            DriveChannel("left_front", "pressure", "Pa"),
            0.45359237 * 9.80665 / 0.0254**2,
        ),
        ("travel_tendon_mm", DriveChannel("tendon", "travel", "m"), 0.001),
        ("angle_servo_deg", DriveChannel("servo", "angle", "rad"), math.pi / 180),
    ],
)
def test_a_column_names_its_channel(column, channel, factor):
    """Quantity, channel and unit are read from a column's name; the factor leads to the SI unit."""
    assert parse_column(column) == (channel, pytest.approx(factor, rel=1e-14))


@pytest.mark.parametrize("quantity", UNITS)
def test_a_channel_and_its_column_name_each_other(quantity):
    """The column of a channel is read as that channel, unconverted."""
    channel = DriveChannel("some_place", quantity, SI_UNITS[quantity])
    assert parse_column(channel.column) == (channel, 1.0)
    assert is_drive_column(channel.column)


@pytest.mark.parametrize(
    ("column", "said"),
    [
        ("pressure_chamber_torr", "'torr' is no unit of pressure that is known, expected pa, hpa, kpa"),
        ("voltage_upper_mm", "expected v, kv, mv: rename the column, for instance voltage_upper_v"),
        ("pressure_mbar", "expected pressure_<channel>_<unit> such as pressure_main_mbar"),
        ("presure_chamber_pa", "did you mean pressure?"),
    ],
)
def test_an_unknown_unit_is_refused_with_the_right_names(column, said):
    """The sentence says which units a quantity has, or what the column should be called."""
    with pytest.raises(RecordingError, match=column):
        parse_column(column)
    with pytest.raises(RecordingError) as refused:
        parse_column(column)
    assert said in str(refused.value)


def test_a_channel_has_its_quantity_in_the_si_unit():
    """A channel in kV is refused: conversion belongs to the reader."""
    with pytest.raises(RecordingError, match="gives its voltage in 'kV', but V is expected"):
        DriveChannel("upper", "voltage", "kV")


def test_prints_with_its_unit():
    """Channel and value print as a person writes them; the rig's columns are the fixed ones."""
    assert str(DriveChannel("chamber", "pressure", "Pa")) == "pressure of chamber [Pa]"
    assert DriveChannel("chamber", "pressure", "Pa").shown(25000.0) == "25000 Pa"
    assert [channel.column for channel in HASEL_PAIR] == ["voltage_upper_v", "voltage_lower_v"]


def read(tmp_path, header):
    """A file whose upper voltage is 2500 in its second row, with these header lines."""
    path = tmp_path / "arm.csv"
    path.write_text(header + "time_s,voltage_upper_v,voltage_lower_v,sin_theta\n0,0,0,0\n0.01,2500,0,0.1\n")
    return read_recording(path)


@pytest.mark.parametrize(
    ("header", "channel", "value"),
    [
        ("#volts_per_mbar: 10\n", DriveChannel("upper", "pressure", "Pa"), 25000.0),
        ("#volts_per_psi: 100\n", DriveChannel("upper", "pressure", "Pa"), 25 * 6894.757293168361),
        ("#volts_per_mm: 500\n", DriveChannel("upper", "travel", "m"), 0.005),
    ],
)
def test_volts_stand_for_another_quantity(tmp_path, header, channel, value):
    """The header says for how much of which quantity a volt stands; name and order of the channels stay."""
    run = read(tmp_path, header)
    assert run.channels[0] == channel
    assert run.channels[1].name == "lower"
    assert run.drive_signal[1].tolist() == pytest.approx([value, 0.0])
    assert "stand for 1" in run.understood[-1]


@pytest.mark.parametrize(
    ("header", "said"),
    [
        ("#volts_per_torr: 10\n", "'volts_per_torr' ends in no unit of v, kv"),
        ("#volts_per_mbar: ten\n", "is 'ten', expected a number of volts other than 0"),
        ("#volts_per_mbar: 0\n", "expected a number of volts other than 0"),
        ("#volts_per_mbar: 10\n#volts_per_mm: 1\n", "volts_per_mbar and volts_per_mm: keep one"),
    ],
)
def test_a_header_line_that_is_not_understood_is_refused(tmp_path, header, said):
    """An unknown unit, no number, or two of them: one sentence."""
    with pytest.raises(RecordingError, match=said):
        read(tmp_path, header)


def test_other_columns_are_not_touched(tmp_path):
    """A pressure that was recorded as such stays as it is."""
    path = tmp_path / "arm.csv"
    path.write_text("#volts_per_mbar: 10\ntime_s,pressure_chamber_mbar,sin_theta\n0,250,0.1\n")
    assert read_recording(path).drive_signal.tolist() == [[25000.0]]
