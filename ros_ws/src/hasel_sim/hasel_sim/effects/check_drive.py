"""Checks of a drive effect over several strokes of both muscles: null, response, and that it knows no future."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import DriveEffect, DriveStage
from hasel_sim.effects.check_tools import called, expect, same

_PERIOD_S, _STROKES, _LEVELS = 0.5, 4, (5000.0, 4000.0)
_CONTRACTION_PER_VOLT = 1e-5
_DRIVEN = (
    f"driven with {_STROKES} strokes of either muscle, in turn every {_PERIOD_S:g} s, at {_LEVELS[0]:g} and "
    f"{_LEVELS[1]:g} V"
)


def check_drive(effect: DriveEffect, null: SimpleNamespace, typical: SimpleNamespace) -> None:
    """Refuse a drive effect that breaks a rule, with a ModelError."""
    expect(
        isinstance(effect.stage, DriveStage),
        effect,
        f"has the stage {effect.stage!r}",
        "use a member of DriveStage",
    )
    time, signal = _strokes()
    if effect.stage >= DriveStage.TARGET:
        signal = _CONTRACTION_PER_VOLT * signal

    def result(p: SimpleNamespace, given: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        response = called(effect, "respond", given.shape, time[: len(given)], given, p)
        return response, called(effect, "clock", (len(given),), time[: len(given)], p)

    (response, clock), (moved, later) = result(null, signal), result(typical, signal)
    expect(
        same(np.abs(response), np.abs(signal)) and same(clock, time),
        effect,
        f"changes the signal at its null values ({_DRIVEN})",
        "make respond return the signal, and clock the time, when every parameter is at null",
    )
    expect(
        not (same(moved, signal) and same(later, time)),
        effect,
        f"does nothing at its typical values ({_DRIVEN})",
        "make respond or clock use its parameters, or raise the typical values",
    )
    so_far = len(time) // 2
    stopped = signal.copy()
    stopped[so_far:] = 0.0
    expect(
        same(result(typical, stopped)[0][: so_far - 1], moved[: so_far - 1]),
        effect,
        "answers to what is commanded later",
        "compute every row of respond from that row and the rows before it only",
    )


def _strokes() -> tuple[np.ndarray, np.ndarray]:
    """Times [s] [n], every switch twice, and voltages [V] [n, 2] of strokes of both muscles in turn."""
    switches = _PERIOD_S * np.arange(1, 2 * _STROKES)
    end = _PERIOD_S * 2 * _STROKES
    time = np.sort(np.concatenate([np.linspace(0.0, end, 961), switches]))
    stroke = np.clip(np.searchsorted(switches, time, side="right"), 0, 2 * _STROKES - 1)
    first = np.isin(np.arange(len(time)), np.searchsorted(time, switches, side="left"))
    stroke = np.where(first, stroke - 1, stroke)
    level = np.where(stroke // 2 % 2 == 0, *_LEVELS)
    return time, np.stack([level * (stroke % 2 == 0), level * (stroke % 2 == 1)], axis=1)
