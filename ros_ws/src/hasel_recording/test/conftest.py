# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A run that the tests write, read and damage."""

from pathlib import Path

import numpy as np
import pytest
from hasel_recording import Recording

CSV_TEXT = """#model: swimmer
#operator: A. Person, evening
time_s,voltage_upper_v,voltage_lower_v,sin_theta
0.000000,3500,0,-0.002241
0.008333,3500,0,0.007149
0.016667,0,-3500.5,1.25e-05
"""


@pytest.fixture
def csv_file(tmp_path: Path) -> Path:
    """A good CSV recording of three frames."""
    path = tmp_path / "run.csv"
    path.write_text(CSV_TEXT, encoding="utf-8")
    return path


@pytest.fixture
def driven() -> Recording:
    """Two seconds at 120 frames/s in which the voltage changes sides on frames."""
    time_s = np.round(np.arange(240) / 120, 6)
    upper = np.where(time_s % 0.5 < 0.25, 3500.0, 0.0)
    return Recording(
        name="driven",
        time_s=time_s,
        sin_theta=np.round(0.1 * np.sin(4 * np.pi * time_s), 6),
        drive_signal=np.column_stack([upper, upper - 3500.0]),
        metadata={"model": "swimmer", "note": "filled with oil: 2.5 ml"},
    )
