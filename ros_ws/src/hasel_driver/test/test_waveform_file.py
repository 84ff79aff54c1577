"""A drive given as a file: what no supply can give is refused with a sentence."""

import pytest
from hasel_driver.errors import LimitError
from hasel_driver.waveform_file import read_waveform

BAD = {
    "rows 1 ms apart, and the driver sends one in 10 ms": "0,0,0\n0.001,100,0\n0.002,0,0",
    "more than 0 and at most 3600 s": "0,0,0\n4000,0,0",
    "above 9800 V": "0,0,0\n1,10000,0\n2,0,0",
}


@pytest.fixture
def write(tmp_path):
    """Writes rows as a file of the three columns."""

    def write(rows: str):
        path = tmp_path / "drive.csv"
        path.write_text(f"time_s,voltage_upper_v,voltage_lower_v\n{rows}\n")
        return path

    return write


@pytest.mark.parametrize("words", BAD)
def test_what_cannot_be_driven_is_refused(write, words):
    """Rows that the command period would skip, a drive that lasts too long, a voltage out of range."""
    with pytest.raises(LimitError, match=words):
        read_waveform(write(BAD[words]))


def test_each_row_holds_until_the_next(write):
    """From the first row's time, which counts as 0, to the last row's, which is the end."""
    drive = read_waveform(write("5,100,-200\n5.01,300,0\n5.5,0,0"))
    assert [drive.voltage(t) for t in (0.0, 0.005, 0.02, 0.51)] == [
        (100, -200),
        (100, -200),
        (300, 0),
        (0, 0),
    ]
    assert drive.duration_s == pytest.approx(0.5)
