# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Settled frames: what counts, what belongs to what, and the noise."""

import numpy as np
import pytest
from hasel_muscle.bench_files import read_bench
from hasel_muscle.settled import settled
from hasel_sysid.errors import SysidError
from numpy.testing import assert_allclose


def test_frames_count_once_the_voltage_has_been_still(bench, tmp_path):
    """A second after a switch frames begin to count; the first rest counts from its start."""
    run = settled(read_bench(bench.write_csv(tmp_path / "a.csv")))
    assert run.time[run.used][0] == 0.0
    first = run.used & (run.level == 1500.0)
    assert_allclose(run.time[first & (run.voltage > 0)].min(), 3.0, atol=0.11)
    assert_allclose(run.time[first & (run.voltage == 0)].min(), 7.0, atol=0.11)
    assert run.level[run.time < 1.9].max() == 0.0


def test_noise_is_that_of_frames_at_rest(bench, tmp_path):
    """A frame is the median of five samples: its noise is that of a median of five normal numbers (0.54)."""
    bench.noise = 1e-5
    run = settled(read_bench(bench.write_csv(tmp_path / "a.csv")))
    assert_allclose(run.noise, 0.54e-5, rtol=0.35)
    assert "at rest" in run.noise_source


def test_the_noise_of_rounded_samples_is_that_of_the_rounding(bench, tmp_path):
    """A sensor that gives hundredths of a millimetre and stands still at rest is no better than these."""
    time, voltage, x = bench.samples()
    rows = "\n".join(f"{t:.3f},{v:.1f},{1e3 * c:.2f}" for t, v, c in zip(time, voltage, x, strict=True))
    (tmp_path / "a.csv").write_text(f"#load_n: 0.5\ntime_s,voltage_v,contraction_mm\n{rows}\n")
    run = settled(read_bench(tmp_path / "a.csv"))
    assert_allclose(run.noise, 1e-5 / np.sqrt(12), rtol=0.01)


def test_single_wild_samples_do_not_move_a_frame(bench, tmp_path):
    """A sensor that sees nothing now and then changes nothing that counts."""
    run = settled(read_bench(bench.write_mat(tmp_path)))
    assert np.abs(run.measured).max() < 0.03


def test_voltages_that_are_never_held_are_refused(tmp_path):
    """A sine has nothing settled: the sentence says what to record."""
    time = np.arange(0.0, 20.0, 0.02)
    volts = 3000 + 2000 * np.sin(2 * np.pi * time)
    rows = "\n".join(f"{t:.2f},{v:.1f},1.0,0.5" for t, v in zip(time, volts, strict=True))
    (tmp_path / "sine.csv").write_text(f"time_s,voltage_v,contraction_mm,load_n\n{rows}\n")
    with pytest.raises(SysidError, match=r"never stays for 1 s and more.*three_lifts"):
        settled(read_bench(tmp_path / "sine.csv"))
