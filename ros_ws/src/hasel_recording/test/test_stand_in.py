import pytest
from hasel_recording import DriveChannel, RecordingError, read_recording


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
