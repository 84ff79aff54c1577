# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
from decimal import Decimal
from pathlib import Path

import pytest
from hasel_recording import RecordingError
from hasel_recording.command_line import convert, convert_main, info_main, target_path
from hypothesis import given, settings
from hypothesis import strategies as st


def test_converts_all_but_the_broken_one(csv_file, tmp_path, capsys):
    """Good recordings are converted, a broken one is an error line and the exit code."""
    broken = tmp_path / "broken.csv"
    broken.write_text("")
    assert convert_main([str(broken), str(csv_file), "--output", str(tmp_path / "out")]) == 1
    printed = capsys.readouterr()
    assert (tmp_path / "out" / "run.mcap").exists()
    assert "run.mcap" in printed.out
    assert (
        printed.err
        == f"error: {broken} is empty: give a file with a row of column names and a row per frame.\n"
    )


def test_warnings_are_lines_too(tmp_path, capsys):
    """What was left out is said on stderr, without Python's decoration."""
    path = tmp_path / "extra.csv"
    path.write_text("time_s,sin_theta,operator\n0,0.1,Ann\n")
    assert info_main([str(path)]) == 0
    assert (
        capsys.readouterr().err
        == f"warning: {path}: column 'operator' is not used; --map says what a column is.\n"
    )


def test_info_shows_the_header(csv_file, capsys):
    """`info` prints the run's sentence and its header lines."""
    assert info_main([str(csv_file)]) == 0
    printed = capsys.readouterr().out
    assert printed.startswith("run: 3 frames")
    assert "model: swimmer" in printed


def test_one_output_file_for_two_recordings(csv_file, capsys):
    """Two recordings cannot become one file."""
    with pytest.raises(SystemExit):
        convert_main([str(csv_file), str(csv_file), "-o", "one.mcap"])
    assert "name a folder" in capsys.readouterr().err


times = st.lists(st.decimals(-1000, 1000, places=7), min_size=1, max_size=20, unique=True).map(sorted)
volts = st.decimals(-10000, 10000, places=2)
sines = st.decimals(-1, 1, places=9)


@settings(max_examples=30, deadline=None)
@given(times=times, data=st.data())
def test_there_and_back_keeps_every_printed_digit(times, data, tmp_path_factory):
    """CSV to MCAP to CSV gives the same numbers, digit by digit, and the same header lines."""
    rows = [[time, data.draw(volts), data.draw(volts), data.draw(sines)] for time in times]
    top = "#model: swimmer\n#note: oil, 2.5: ml\ntime_s,voltage_upper_v,voltage_lower_v,sin_theta\n"
    source = tmp_path_factory.mktemp("convert") / "run.csv"
    source.write_text(top + "".join(",".join(map(str, row)) + "\n" for row in rows))
    back = convert(convert(source), source.with_name("back.csv"))
    lines = back.read_text().splitlines()
    assert lines[:3] == top.splitlines()
    assert [[Decimal(cell) for cell in line.split(",")] for line in lines[3:]] == rows


def test_target_lies_beside_the_source_or_where_asked():
    """Without output the other suffix is used beside the source; output may be a folder or a file."""
    source = Path("data/run.csv")
    assert target_path(source) == Path("data/run.mcap")
    assert target_path(source, Path("out")) == Path("out/run.mcap")
    assert target_path(source, Path("out/other.mcap")) == Path("out/other.mcap")
    assert target_path(Path("data/run.mcap")) == Path("data/run.csv")
    assert target_path(Path("bag")) == Path("bag.csv")


def test_existing_file_is_kept(csv_file):
    """A file that is there already is replaced only on demand."""
    target = convert(csv_file)
    before = target.stat().st_mtime_ns
    with pytest.raises(RecordingError, match="exists already"):
        convert(csv_file)
    assert target.stat().st_mtime_ns == before
    assert convert(csv_file, replace=True) == target
