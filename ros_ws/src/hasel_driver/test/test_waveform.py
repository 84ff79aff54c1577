# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Waveforms: shapes, order of the muscles, polarity, ranges."""

import numpy as np
import pytest
from hasel_driver.protocol.faults import LimitError
from hasel_driver.protocol.waveform import Waveform
from hypothesis import given
from hypothesis import strategies as st

TIMES_S = np.arange(0.0, 2.0, 0.001) + 0.0005


def series(waveform: Waveform) -> np.ndarray:
    """Voltages at TIMES_S [n, 2]."""
    return np.array([waveform.voltage(time_s) for time_s in TIMES_S])


def test_box_drives_one_muscle_after_the_other():
    """With full duty exactly one muscle is driven at any time, the upper first."""
    voltage = series(Waveform("box", 5000.0, 1.0, 2))
    assert ((voltage > 0).sum(axis=1) == 1).all()
    assert voltage[0].tolist() == [5000.0, 0.0]
    assert voltage[750].tolist() == [0.0, 5000.0]


@pytest.mark.parametrize(
    ("shape", "mean"), [("box", 1.0), ("ramp", 0.5), ("triangle", 0.5), ("sine", 2 / np.pi)]
)
def test_mean_of_each_shape(shape, mean):
    """The mean over a drive is the shape's integral."""
    upper = series(Waveform(shape, 1000.0, 1.0, 2, muscles="upper"))[:500, 0]
    assert upper.mean() == pytest.approx(1000.0 * mean, rel=1e-4)


def test_alternating_polarity_changes_with_every_drive():
    """Each muscle sees the same number of drives of either sign, so no charge accumulates."""
    voltage = series(Waveform("box", 1000.0, 2.0, 4, polarity="alternating"))
    assert voltage.sum(axis=0) == pytest.approx([0.0, 0.0])
    assert voltage[[0, 300, 500, 800]].tolist() == [[1000, 0], [0, 1000], [-1000, 0], [0, -1000]]


def test_lower_first_swaps_the_muscles():
    """`lower_first` is `both` with the columns exchanged."""
    both = series(Waveform("ramp", 1000.0, 1.5, 2))
    assert (series(Waveform("ramp", 1000.0, 1.5, 2, muscles="lower_first")) == both[:, ::-1]).all()


@given(st.floats(0.01, 50), st.integers(1, 100), st.floats(0.001, 1), st.floats(-1, 100))
def test_never_above_its_voltage_and_zero_outside(frequency, periods, duty, time_s):
    """|V| never exceeds the peak, and is 0 before the begin and after the end."""
    waveform = Waveform("sine", 3000.0, frequency, periods, duty, "alternating")
    voltage = waveform.voltage(time_s)
    assert max(map(abs, voltage)) <= 3000.0
    if not 0 <= time_s < waveform.duration_s:
        assert voltage == (0.0, 0.0)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"voltage_v": 12_000.0}, "voltage_v is 12000.0, 0 to 10000 was expected"),
        ({"voltage_v": float("nan")}, "voltage_v is nan"),
        ({"frequency_hz": 0.0}, "frequency_hz is 0.0, 0.01 to 50"),
        ({"periods": 0}, "periods is 0, 1 to 60000"),
        ({"shape": "saw"}, "shape is 'saw', one of box, ramp, sine, triangle"),
        ({"muscles": "left"}, "muscles is 'left', one of both, upper, lower, lower_first"),
    ],
)
def test_says_what_is_out_of_range(change, words):
    """A bad argument is named, with what was expected."""
    arguments = {"shape": "box", "voltage_v": 1000.0, "frequency_hz": 1.0, "periods": 1} | change
    with pytest.raises(LimitError, match=words):
        Waveform(**arguments)
