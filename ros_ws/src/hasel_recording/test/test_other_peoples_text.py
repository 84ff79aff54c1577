# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""CSV files as spreadsheets, loggers and other programs write them."""

import warnings

import numpy as np
import pytest
from hasel_recording import RecordingError, RecordingWarning, read_recording
from hasel_recording.csv_columns import parse_map

TOP = "time_s,voltage_upper_v,sin_theta\n"


def read(tmp_path, text, name="run.csv", mapping="", **how):
    """The recording of this text."""
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_recording(path, parse_map(mapping), **how)


@pytest.mark.parametrize(
    ("text", "volts"),
    [
        (TOP + '0,900,0.01\n0.5,"1,100",0.02\n', [900, 1100]),
        (TOP + '0,900,0.01\n0.5,"5,500,000.5",0.02\n', [900, 5500000.5]),
        (TOP.replace(",", ";") + "0;3.500;0,01\n0,5;1.100,25;0,02\n", [3500, 1100.25]),
        (TOP.replace(",", ";") + "0;3.500;0,01\n0,5;900;0,02\n", [3500, 900]),
        (TOP.replace(",", ";") + "1;3,500;0\n2;1,125;1\n", [3.5, 1.125]),
        (TOP.replace(",", "\t") + "0\t3 500\t0.01\n0.5\t1 100.5\t0.02\n", [3500, 1100.5]),
        (TOP + "0,3\u00a0500,0.01\n0.5,1\u202f100,0.02\n", [3500, 1100]),
        (TOP + "0,3'500,0.01\n0.5,1\u2019100,0.02\n", [3500, 1100]),
        (TOP.replace(",", ";") + "0;3,5;0.01\n0.5;1,25;0.02\n", [3.5, 1.25]),
        (TOP + "0,\u22123500,0.01\n0.5,+1.1e3,0.02\n", [-3500, 1100]),
        (TOP + "0,3.500,0.01\n0.5,1.100,0.02\n", [3.5, 1.1]),
    ],
)
def test_groups_of_digits_are_told_from_decimals(tmp_path, text, volts):
    """Groups by comma, point, blank or apostrophe, told by the file as a whole: a thousand is never taken for one."""
    assert read(tmp_path, text).drive_signal[:, 0].tolist() == volts


def test_a_number_that_may_be_two_is_refused(tmp_path):
    """Where nothing in the file tells groups from decimals, both readings are named."""
    with pytest.raises(RecordingError, match=r"'1,100' in column voltage_upper_v may be 1.1 or 1100: write"):
        read(tmp_path, TOP + '0,"1,100",0\n1,"1,200",1\n')


def test_an_open_quotation_mark_is_refused_with_its_line(tmp_path):
    """An open quote swallows no frame, however long the file is."""
    rows = [f"{0.01 * number:.2f},5000,0.1\n" for number in range(20000)]
    rows[400] = '4.00,"5000,0.1\n'
    with pytest.raises(RecordingError, match="line 402 has a quotation mark that is not closed"):
        read(tmp_path, TOP + "".join(rows))


def test_columns_without_a_name(tmp_path):
    """Blank ones are left out; one with cells is named by its number, and can be mapped by it."""
    blank = read(tmp_path, TOP.strip() + ",,\n0,5000,0.1,,\n0.5,5000,0.2\n")
    assert blank.sin_theta.tolist() == [0.1, 0.2]
    index = ",time_s,sin_theta\n0,0.0,0.1\n1,0.5,0.2\n"
    with pytest.warns(RecordingWarning, match="column '#1' is not used"):
        read(tmp_path, index)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = read(
            tmp_path,
            ",,\n0,0.1,5000\n0.5,0.2,5000\n".replace(",,", "t,,"),
            mapping="time=#1,sin_theta=#2,voltage_upper=#3",
        )
    assert run.drive_signal[:, 0].tolist() == [5000, 5000]


def test_blank_rows_on_top_are_passed_over(tmp_path):
    """A spreadsheet's empty first rows are separators only."""
    assert read(tmp_path, ",,\n\n,,\n" + TOP + "0,5000,0.1\n").sin_theta.tolist() == [0.1]


def test_older_spreadsheets_text(tmp_path):
    """Dots, dashes and quotes of Windows in header lines end no line: the line that is wrong is named."""
    head = "#note: tail \u2026 \u201cnew\u201d \u2013 5 \u20ac\n"
    run = read(tmp_path, (head + TOP + "0,5000,0.1\n").encode("cp1252"))
    assert run.metadata["note"] == "tail \u2026 \u201cnew\u201d \u2013 5 \u20ac"
    with pytest.raises(RecordingError, match="line 4: 'x' in column sin_theta"):
        read(tmp_path, (head + TOP + "0,5000,0.1\n0.5,5000,x\n").encode("cp1252"))


def test_rows_that_repeat_are_left_out_aloud(tmp_path):
    """A row written twice is one frame."""
    with pytest.warns(RecordingWarning, match="2 rows that repeat the one before were left out"):
        run = read(tmp_path, TOP + "0,5000,0.1\n0,5000,0.1\n0.1,5000,0.2\n0.1,5000,0.2\n")
    assert run.time_s.tolist() == [0.0, 0.1]


@pytest.mark.parametrize(
    ("times", "said"),
    [
        (
            [0, 0, 0, 1, 1, 1],
            "4 rows share the time of the one before, rounded to 1 s: write it with more digits",
        ),
        ([0, 0.1, 0.1, 0.2], "1 rows share the time of the one before: write it with more digits"),
        ([5, 5.1, 5.2, 0.0, 0.1], "the clock starts anew there, as after a restart: make two recordings"),
        ([5, 5.1, 5.3, 5.2, 5.4], "sort the rows by time"),
    ],
)
def test_times_that_do_not_increase(tmp_path, times, said):
    """Rounded times, a restarted clock and rows out of order get advice that loses no frame."""
    rows = "".join(f"{time},{number},0.1\n" for number, time in enumerate(times))
    with pytest.raises(RecordingError, match=said):
        read(tmp_path, TOP + rows)


@pytest.mark.parametrize(
    ("unit", "start", "step", "span"),
    [
        ("us", 2**32 - 30000, 8333, 2**32),
        ("ms", 2**32 - 30, 8, 2**32),
        ("ms", 65500, 8, 2**16),
        ("s", 86399.98, 0.01, 86400.0),
    ],
)
def test_clocks_that_wrap_are_counted_on(tmp_path, unit, start, step, span):
    """micros(), millis(), 16 bits and midnight: the times go on, and it is said."""
    times = [(start + step * number) % span for number in range(10)]
    rows = "".join(f"{time:.6f},0,0.1{number}\n" for number, time in enumerate(times))
    with pytest.warns(RecordingWarning, match="starts again after .* it is counted on"):
        run = read(tmp_path, f"time_{unit},voltage_upper_v,sin_theta\n{rows}")
    size = {"us": 1e-6, "ms": 1e-3, "s": 1.0}[unit]
    np.testing.assert_allclose(np.diff(run.time_s), step * size, rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize(
    "times",
    [
        ["12:00:00.00", "12:00:00.25", "12:00:00.50"],
        ["2026-11-28T12:00:00", "2026-11-28T12:00:00.250", "2026-11-28T12:00:00.500"],
        ["59:59,75", "60:00,00", "60:00,25"],
    ],
)
def test_times_of_day_and_dates(tmp_path, times):
    """Clock times and ISO dates are seconds."""
    run = read(
        tmp_path, "time_s;sin_theta\n" + "".join(f"{time};0,{number}\n" for number, time in enumerate(times))
    )
    np.testing.assert_allclose(np.diff(run.time_s), 0.25)


def test_a_map_names_any_column(tmp_path):
    """A name with commas and brackets; the drive's own file too, whose time has another name."""
    text = '"t, s","angle (deg), filtered"\n0,0\n0.1,30\n'
    (tmp_path / "supply.csv").write_text("Zeit,U1 [kV]\n0,0\n0.05,5.5\n")
    mapping = "time=t, s,sin_theta=angle (deg), filtered,drive.time=Zeit,voltage_upper_kv=U1 [kV]"
    with pytest.raises(
        RecordingError, match=r"no column 'time_s' .* only Zeit, U1 \[kV\].* --map drive.time_s="
    ):
        read(
            tmp_path, text, mapping="time=t, s,theta_deg=angle (deg), filtered", drive=tmp_path / "supply.csv"
        )
    run = read(
        tmp_path, text, mapping=mapping.replace("sin_theta=", "theta_deg="), drive=tmp_path / "supply.csv"
    )
    assert run.sin_theta == pytest.approx([0, 0.5])
    assert run.drive()[0].tolist() == [0.0, 0.05]
    assert run.drive()[1].ravel().tolist() == [0.0, 5500.0]


LVM = (
    "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\nDecimal_Separator\t,\n***End_of_Header***\t\n\t\n"
    "Channels\t2\nSamples\t2\t2\n***End_of_Header***\t\t\nX_Value\tangle\tvoltage_upper_v\tComment\n"
    "0,000000\t0,01\t0,0\n0,008333\t0,02\t5500,0\n"
)


def test_labview_measurements_are_read(tmp_path):
    """An .lvm file is read from the end of its header on, its columns named with a map."""
    run = read(tmp_path, LVM, "run.lvm", "time=X_Value,sin_theta=angle")
    assert run.time_s.tolist() == [0.0, 0.008333]
    assert run.drive_signal[:, 0].tolist() == [0, 5500]


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("take.csv", "Format Version,1.23,Take Name,Take 1\n\n,Type,Marker\n", "an export of Motive"),
        (
            "dlc.csv",
            "scorer,DLC_resnet50,DLC_resnet50\nbodyparts,head,head\ncoords,x,y\n0,1,2\n",
            "an export of DeepLabCut",
        ),
        ("q.tsv", "NO_OF_FRAMES\t100\nNO_OF_CAMERAS\t8\n", "an export of Qualisys"),
    ],
)
def test_other_programs_exports_say_what_to_do(tmp_path, name, text, said):
    """Motive, DeepLabCut and Qualisys files are named for what they are, with the columns that are wanted."""
    with pytest.raises(RecordingError, match=f"{said}.*time_s, head_x"):
        read(tmp_path, text, name)
