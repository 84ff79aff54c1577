# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Files of a bench: the lab's CSV, the public repository's MATLAB files, and what is wrong with them."""

import sys

import h5py
import numpy as np
import pytest
from hasel_muscle.bench_files import muscle_beside, read_bench, read_bench_mat
from hasel_muscle.bench_recording import read_bench_csv
from hasel_recording.errors import RecordingError
from numpy.testing import assert_allclose


@pytest.fixture
def csv(tmp_path):
    """Writes a CSV file; returns its path."""

    def write(text):
        (tmp_path / "bench.csv").write_text(text)
        return tmp_path / "bench.csv"

    return write


def test_units_are_those_of_the_columns(csv):
    """Kilovolts, millimetres, grams, microamperes come out in SI units; time begins at 0; a blank is not measured."""
    read = read_bench_csv(
        csv(
            "time_ms,voltage_kv,contraction_mm,load_g,current_ua\n500,0,0,100,1\n600,1.5,,100,2\n700,-1.5,2,100,3\n"
        )
    )
    assert_allclose(read.time, [0.0, 0.1, 0.2])
    assert_allclose(read.voltage, [0.0, 1500.0, -1500.0])
    assert_allclose(read.contraction, [0.0, np.nan, 2e-3])
    assert_allclose(read.load, 0.980665)
    assert_allclose(read.current, [1e-6, 2e-6, 3e-6])
    assert read.held == "load"


def test_a_map_names_the_columns(csv):
    """By name or number; a unit that is not given is that of the column's own name, else the SI unit."""
    path = csv("t [ms],U_kV,x,m,I\n500,0,0,100,1\n600,1.5,0.002,100,2\n")
    mapping = {"time": "t [ms]", "voltage": "U_kV", "contraction": "x", "load_g": "#4", "current_ua": "I"}
    read = read_bench(path, mapping)
    assert_allclose(read.time, [0.0, 0.1])
    assert_allclose(read.voltage, [0.0, 1500.0])
    assert_allclose(read.contraction, [0.0, 2e-3])
    assert_allclose(read.load, 0.980665)
    assert_allclose(read.current, [1e-6, 2e-6])
    with pytest.raises(
        RecordingError, match="nothing is called 'contracton' here: did you mean 'contraction'"
    ):
        read_bench(path, {**mapping, "contracton": "x"})
    with pytest.raises(RecordingError, match=r"no column 'y' for contraction=y: choose among t \[ms\]"):
        read_bench(path, {**mapping, "contraction": "y"})


def test_a_held_contraction_is_said_in_the_header(csv):
    """Then the load is the answer."""
    read = read_bench_csv(
        csv("#held: contraction\ntime_s,voltage_v,contraction_m,load_n\n0,0,0.001,0\n1,5,0.001,2\n")
    )
    assert read.held == "contraction"
    assert_allclose(read.answer, [0.0, 2.0])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("time_s,voltage_v,stroke_mm\n0,0,0\n1,0,0\n", "no column contraction_<unit>"),
        ("time_s,voltage_v,contracton_mm\n0,0,0\n1,0,0\n", "did you mean contraction_m"),
        ("time_s,voltage_v,contraction_in\n0,0,0\n1,0,0\n", "one of m, cm, mm, um"),
        ("time_s,voltage_v,contraction_m\n0,0,0\n1,0,0\n", "says no load"),
        ("#load_n: heavy\ntime_s,voltage_v,contraction_m\n0,0,0\n1,0,0\n", "'heavy'; expected a number"),
        (
            "#held: breath\ntime_s,voltage_v,contraction_m,load_n\n0,0,0,1\n",
            "load or contraction was expected",
        ),
        ("time_s,voltage_v,contraction_m,load_n\n0,0,0,1\n0,0,0,2\n", "does not come after"),
        ("time_s,voltage_v,contraction_m,load_n\n0,0,0,1\n1,x,0,1\n", "line 3: 'x' in column voltage_v"),
    ],
)
def test_faults_of_a_csv_get_one_sentence(csv, text, message):
    """What was found, what was expected."""
    with pytest.raises(RecordingError, match=message):
        read_bench_csv(csv(text))


def test_the_public_format_is_read_in_si_units(bench, tmp_path):
    """Logger volts become volts, metres and amperes; the load is in the name; what the sensor did not see is NaN."""
    path = bench.write_mat(tmp_path)
    time, voltage, x = bench.samples()
    read = read_bench_mat(path)
    assert_allclose(read.voltage, voltage)
    assert_allclose(np.delete(read.contraction - 16e-3, 500), np.delete(x, 500), atol=1e-12)
    assert np.isnan(read.contraction[500])
    assert_allclose(read.load, 0.5, rtol=1e-3)
    assert_allclose(read.current, np.gradient(voltage, time) * 1e-9, atol=1e-15)


def test_the_muscle_is_described_beside_it(bench, tmp_path):
    """Dimensions of the whole muscle become those of one pouch; that file is never run."""
    muscle = muscle_beside(bench.write_mat(tmp_path))
    assert muscle.count == 10
    assert_allclose(muscle.pouch.film_length, 0.020)
    assert_allclose(muscle.pouch.width, 0.050)
    assert muscle.pouch.relative_permittivity == 3.15


def test_a_description_that_lacks_something_is_refused(bench, tmp_path):
    """The missing names are said."""
    path = bench.write_mat(tmp_path)
    (tmp_path / "parameters.py").write_text("w = 0.05\n")
    with pytest.raises(RecordingError, match="does not say n_pouches, t, eps_r, Lp, Le"):
        muscle_beside(path)


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("60g__a.mat", None, "no MATLAB 7.3 file"),
        ("60g__a.mat", {"other": np.zeros((5, 9))}, "no table of numbers called 'data'"),
        ("60g__a.mat", {"data": np.zeros((4, 9))}, "expected 5 columns"),
        ("60g__a.mat", {"data": np.zeros((5, 9))}, "times do not increase"),
        ("step.mat", {"data": np.tile(np.arange(9.0), (5, 1))}, "does not begin with the mass"),
    ],
)
def test_faults_of_a_mat_file_get_one_sentence(tmp_path, name, content, message):
    """What was found, what was expected."""
    path = tmp_path / name
    if content is None:
        path.write_text("not HDF5")
    else:
        with h5py.File(path, "w") as file:
            for key, value in content.items():
                file[key] = value
    with pytest.raises(RecordingError, match=message):
        read_bench(path)


def test_other_files_are_refused(tmp_path):
    """A name that is not there, and a kind that is not read."""
    with pytest.raises(RecordingError, match="there is no recording"):
        read_bench(tmp_path / "none.csv")
    (tmp_path / "a.xlsx").write_text("")
    with pytest.raises(RecordingError, match=r"not '\.xlsx'"):
        read_bench(tmp_path / "a.xlsx")


def test_matlab_files_need_h5py(bench, tmp_path, monkeypatch):
    """It is an extra: where it is missing, a sentence says what to do."""
    path = bench.write_mat(tmp_path)
    monkeypatch.setitem(sys.modules, "h5py", None)
    with pytest.raises(RecordingError, match=r"h5py, which reads MATLAB 7\.3 files, is not installed"):
        read_bench_mat(path)
