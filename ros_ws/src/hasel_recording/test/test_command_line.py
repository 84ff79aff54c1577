import pytest
from hasel_recording.command_line import convert_main, info_main


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
