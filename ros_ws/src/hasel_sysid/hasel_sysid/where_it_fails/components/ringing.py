"""A damped oscillation after every switch that the simulation does not have (or has too much of)."""

import numpy as np

from hasel_sysid.where_it_fails.component import Component, Kind
from hasel_sysid.where_it_fails.components.added import explained_by
from hasel_sysid.where_it_fails.components.aligned import Alignment
from hasel_sysid.where_it_fails.run_series import RunSeries

_CYCLES_IN_A_DECAY = (0.5, 1.0, 2.0, 5.0)
_HIGHEST_HZ = 25.0
_TRIALS = 40


def _columns(since: np.ndarray, side: np.ndarray, frequency: float, decay: float) -> np.ndarray:
    envelope = side * np.exp(-decay * since)
    angle = 2 * np.pi * frequency * since
    return np.column_stack([envelope * np.cos(angle), envelope * np.sin(angle)])


def _explained(base: np.ndarray, left: np.ndarray, columns: np.ndarray) -> float:
    own = columns - base @ (base.T @ columns)
    coefficients = np.linalg.lstsq(own, left, rcond=None)[0]
    return float(left @ own @ coefficients)


def ringing(run: RunSeries, aligned: Alignment) -> Component | None:
    """The oscillation that explains most; None when the drive has no switches or too short a time between them.

    value: amplitude in sin theta just after a switch; detail: frequency_hz and decay_per_s.
    """
    if run.cycle is None or run.frame_time <= 0:
        return None
    between = float(np.median(np.diff(run.cycle.switches)))
    lowest, highest = 1.0 / between, min(_HIGHEST_HZ, 0.2 / run.frame_time)
    if highest <= lowest:
        return None
    trials = [
        (frequency, frequency / cycles)
        for frequency in np.geomspace(lowest, highest, _TRIALS)
        for cycles in _CYCLES_IN_A_DECAY
    ]
    since, side = run.cycle.since_switch(run.time)
    since = np.nan_to_num(since)
    base, _ = np.linalg.qr(aligned.columns)
    left = aligned.remainder - base @ (base.T @ aligned.remainder)
    frequency, decay = max(trials, key=lambda trial: _explained(base, left, _columns(since, side, *trial)))
    fitted, size = explained_by(aligned, _columns(since, side, frequency, decay), run.frame_time)
    pair, covariance = fitted.coefficients[:2], fitted.covariance[:2, :2]
    amplitude = float(np.hypot(*pair))
    error = float(np.sqrt(max(pair @ covariance @ pair, 0.0))) / amplitude if amplitude > 0 else 0.0
    return Component(
        Kind.RINGING,
        amplitude,
        error,
        "1",
        size,
        {"frequency_hz": float(frequency), "decay_per_s": float(decay)},
    )
