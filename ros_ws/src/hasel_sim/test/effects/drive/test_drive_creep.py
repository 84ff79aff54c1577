# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Drive creep."""

import numpy as np
import pytest


def test_a_held_drive_goes_on_growing_with_its_own_time(response):
    """A step reaches 1 - beta at once and the rest as 1 - exp(-t / tau)."""
    time = np.linspace(0.0, 5.0, 501)
    found = response("drive_creep", time, np.full((501, 1), 2.0e4), fraction=0.2, time=1.5)[:, 0]
    assert found[1:] == pytest.approx(2.0e4 * (1.0 - 0.2 * np.exp(-time[1:] / 1.5)), rel=1e-6)


def test_after_letting_off_what_has_crept_fades(response):
    """Switched off after ten times its time, a share beta of the drive is left and halves in tau ln 2."""
    time = np.array([0.0, 5.0, 5.0, 5.0 + 0.5 * np.log(2.0)])
    signal = np.array([[1.0], [1.0], [0.0], [0.0]])
    found = response("drive_creep", time, signal, fraction=0.3, time=0.5)[:, 0]
    assert found[2:] == pytest.approx([0.3, 0.15], rel=1e-3)
