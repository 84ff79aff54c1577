# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""First-order lag of a signal with jumps: what charging electrodes and flowing liquid have in common."""

import numpy as np
from numba import njit


@njit(cache=True)
def first_order_lag(time: np.ndarray, signal: np.ndarray, rise_time: float, fall_time: float) -> np.ndarray:
    """Follow a signal [n, 2] by dy/dt = (signal - y) / tau from 0, tau being that of a rising or a falling magnitude.

    Exact for a signal that is constant, or changes steadily, between its times [s] [n]; equal times mark a jump. A time
    constant of 0 follows at once.
    """
    out = np.empty_like(signal)
    for muscle in range(signal.shape[1]):
        y, before = 0.0, 0.0
        for i in range(signal.shape[0]):
            left, after = time[i] - time[max(i - 1, 0)], signal[i, muscle]
            change, start = after - before, before
            whole = left
            aim = 0.5 * (before + after)
            if y * aim < 0.0 and left > 0.0:
                # The old charge goes first; at zero the other polarity begins to rise.
                if fall_time > 0.0:
                    to_zero = fall_time * np.log1p(-y / aim)
                    if to_zero < left:
                        start += change * to_zero / whole
                        y, left = 0.0, left - to_zero
                else:
                    y = 0.0
            tau = rise_time if y * aim >= 0.0 and abs(aim) >= abs(y) else fall_time
            if tau <= 0.0:
                y = after
            elif left > 0.0:
                fade = np.exp(-left / tau)
                gradient = change / whole
                y = after - gradient * tau * (1.0 - fade) + (y - start) * fade
            out[i, muscle] = y
            before = after
    return out
