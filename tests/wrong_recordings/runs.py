# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Runs of a swimmer-like oscillator with a faulty set-up, one for each kind, and models that do not go with them."""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from hasel_recording import HASEL_PAIR, DriveChannel, Recording
from hasel_recording.switch_times import with_placed_switches
from hasel_sim.model import load_model
from hasel_sim.parallel import SerialExecutor
from hasel_sysid.data_quality import check_against_model, check_recording, refusal
from hasel_sysid.dataset import check_levels, matched, prepared, simulable, usable
from hasel_sysid.experiment import check_unseen, experiment_of
from scipy.signal import lsim

TIME = np.arange(0, 2, 1 / 120)
NOISE = 0.002 * np.random.default_rng(0).normal(size=len(TIME))
CHAMBER, TENDON = DriveChannel("chamber", "pressure", "Pa"), DriveChannel("tendon", "travel", "m")


def _swing() -> np.ndarray:
    """sin theta of an oscillator of 2.4 Hz that is pulled by a box of 2 Hz, from rest."""
    fine = np.arange(0, 2.1, 1 / 2400)
    pull = np.interp(fine, fine + 0.02, np.where(np.mod(2 * fine, 1) < 0.5, 0.2, -0.2), left=0.0)
    omega = 2 * np.pi * 2.4
    _, angle, _ = lsim(([omega**2], [1, 0.3 * omega, omega**2]), pull, fine)
    return np.interp(TIME, fine, angle)


SIMULATED = _swing()
FIRST_HALF = np.mod(2 * TIME + 1e-9, 1) < 0.5
BOX = 4500.0 * np.column_stack([FIRST_HALF, ~FIRST_HALF])
GOOD = Recording("run", TIME, SIMULATED + NOISE, BOX)


def _with(**fields) -> Recording:
    return replace(GOOD, **fields)


def _angle(rows: slice | list[int], value: float) -> Recording:
    angle = GOOD.sin_theta.copy()
    angle[rows] = value
    return _with(sin_theta=angle)


def _only(rows: np.ndarray) -> Recording:
    return _with(time_s=TIME[rows], sin_theta=GOOD.sin_theta[rows], drive_signal=BOX[rows])


def _markers(order: tuple[int, ...] = (0, 1, 2), rows: slice = slice(None), scale: float = 1.0) -> np.ndarray:
    angle = np.arcsin(GOOD.sin_theta)
    head, middle = np.array([0.005, 0.0]), np.array([0.094, 0.0])
    tail = middle + 0.096 * np.column_stack([np.cos(angle), np.sin(angle)])
    markers = np.stack([np.tile(head, (len(TIME), 1)), np.tile(middle, (len(TIME), 1)), tail], axis=1)
    markers[rows] = markers[rows][:, order]
    return scale * markers


def _late(seconds: float) -> np.ndarray:
    return np.interp(TIME - seconds, TIME, SIMULATED) + NOISE


_rows = np.arange(len(TIME))
_swapped = TIME.copy()
_swapped[[50, 51]] = TIME[[51, 50]]
_shake = np.random.default_rng(3).uniform(-0.4, 0.4, len(TIME)) / 120
_sine = np.minimum(4000.0, 4500.0 * np.abs(np.sin(4 * np.pi * TIME + 1e-9))[:, None] * (BOX > 0))
_slow = np.arange(0, 3, 1 / 30)
_slow_half = np.mod(2 * _slow + 1e-9, 1) < 0.5
_slow_noise = 0.002 * np.random.default_rng(0).normal(size=len(_slow))
_night = np.arange(0, 7200, 1 / 30)
_four = np.arange(0, 4, 1 / 120)
_four_half = np.mod(2 * _four + 1e-9, 1) < 0.5

ALONE = [
    _only(_rows[:10]),
    _with(time_s=_swapped),
    _with(time_s=TIME * 1e3),
    _with(time_s=TIME * 1e-3),
    Recording("run", _night, 0.1 * np.sin(_night)),
    _only(np.setdiff1d(_rows, [40, 41, 42, 90])),
    _with(time_s=TIME + _shake),
    _only(_rows[::8]),
    _angle(slice(60, 64), np.nan),
    _with(sin_theta=np.degrees(np.arcsin(GOOD.sin_theta))),
    _angle(slice(80, 140), GOOD.sin_theta[80]),
    _angle([70, 71, 150], 0.9),
    _with(sin_theta=NOISE),
    _with(drive_signal=np.tile([4500.0, 0.0], (len(TIME), 1))),
    _with(drive_signal=BOX / 1e3),
    _with(drive_signal=BOX[:, :1] * 5e-5, channels=(CHAMBER,)),
    _with(drive_signal=BOX[:, :1] / 1e3, channels=(TENDON,)),
    _with(drive_signal=0 * BOX),
    _with(drive_signal=np.where(TIME[:, None] < 1, BOX, np.nan)),
    _with(drive_signal=BOX * (1, 0)),
    _with(drive_signal=BOX * (0, 1), metadata={"muscles": "both"}),
    _with(sin_theta=np.where(GOOD.sin_theta > 0, GOOD.sin_theta, 0.05 * GOOD.sin_theta)),
    _with(drive_signal=np.repeat(BOX[:, :1], 2, axis=1)),
    _with(metadata={"voltage_v": "6000"}),
    _with(drive_signal=BOX * (1, 0.9)),
    _with(drive_signal=_sine),
    _with(drive_signal=BOX[np.where(np.abs(_rows - 95) <= 5, 89, _rows)]),
    _with(metadata={"frequency_hz": "2.5"}),
    _with(sin_theta=(BOX[:, 0] - BOX[:, 1]) * 1e-4),
    _with(sin_theta=-GOOD.sin_theta),
    _with(
        time_s=np.arange(len(TIME) + 12) / 120,
        sin_theta=np.concatenate([NOISE[:12], GOOD.sin_theta]),
        drive_signal=np.vstack([np.zeros((48, 2)), BOX[:-36]]),
    ),
    _with(sin_theta=np.concatenate([NOISE[:48], GOOD.sin_theta[:-48]])),
    Recording(
        "run", _four, 0.2 * np.sin(2 * np.pi * 2.9 * _four), 5e3 * np.column_stack([_four_half, ~_four_half])
    ),
    Recording(
        "run",
        _slow,
        0.25 * np.sin(4 * np.pi * _slow) + _slow_noise,
        5e3 * np.column_stack([_slow_half, ~_slow_half]),
    ),
    _with(markers=_markers(scale=1e3)),
    _with(markers=_markers((0, 2, 1))),
    _with(markers=_markers((2, 1, 0), slice(100, 120))),
    _with(markers=_markers((2, 1, 0))),
    _with(markers=_markers(), sin_theta=50 * GOOD.sin_theta),
    _with(markers=_markers(), sin_theta=0.9 * GOOD.sin_theta),
    _with(metadata={"initial_time_s": "soon"}),
    _with(metadata={"initial_time_s": "50"}),
    _with(metadata={"initial_stat": "rest"}),
]
LOWER_LATE = np.interp(TIME - 0.02 * ~FIRST_HALF, TIME, SIMULATED) + NOISE
AGAINST_MODEL = [
    (_with(sin_theta=SIMULATED), SIMULATED),
    (_with(sin_theta=-GOOD.sin_theta), SIMULATED),
    (_with(sin_theta=np.degrees(GOOD.sin_theta) / 100), SIMULATED / 100),
    (_with(sin_theta=10 * GOOD.sin_theta / 100), SIMULATED / 100),
    (_with(sin_theta=_late(0.115)), SIMULATED),
    (_with(sin_theta=LOWER_LATE), SIMULATED),
]
LENGTHS = np.ones((len(TIME), 1, 1)) * np.array([[0.005, 0.0], [0.080, 0.0], [0.190, 0.0]])


def inputs() -> Iterator[Callable]:
    """Each a call that gives findings, or refuses."""
    for recording in ALONE:
        yield lambda recording=recording: [*check_recording(recording), refusal(recording)]
    for recording, simulated in AGAINST_MODEL:
        yield lambda own=recording, simulated=simulated: check_against_model(own, simulated)
    for markers in (LENGTHS[:, ::-1], 1e3 * LENGTHS):
        yield lambda m=markers: check_against_model(_with(markers=m), SIMULATED, LENGTHS)
    yield lambda: experiment_of(_with(metadata={"initial_state": "moving"}))
    yield lambda: experiment_of(_with(metadata={"initial_time_s": "soon"}))
    yield lambda: usable([_only(_rows[:10])])
    copy = replace(GOOD, name="other")
    yield lambda: usable([GOOD, copy])
    yield lambda: check_unseen([experiment_of(copy)], [experiment_of(GOOD)])
    yield from _models()


def _models() -> Iterator[Callable]:
    swimmer, beam = load_model("swimmer"), load_model("beam")
    third, lowr = DriveChannel("third", "voltage", "V"), DriveChannel("lowr", "voltage", "V")
    threefold = np.column_stack([0 * TIME, BOX])
    fitted = swimmer.with_levels([4.5])
    for model, recording in (
        (swimmer, _with(drive_signal=threefold, channels=(third, *HASEL_PAIR))),
        (swimmer, _with(drive_signal=threefold + 10.0, channels=(third, *HASEL_PAIR))),
        (swimmer, _with(channels=(HASEL_PAIR[0], lowr))),
        (swimmer, _with(drive_signal=BOX[:, :1], channels=HASEL_PAIR[:1])),
        (swimmer, _with(drive_signal=None)),
        (swimmer, _with(channels=tuple(DriveChannel(each.name, "pressure", "Pa") for each in HASEL_PAIR))),
        (beam, GOOD),
    ):
        yield lambda model=model, recording=recording: matched(model, [recording])
    yield lambda: check_levels(swimmer.with_levels([1000.0]), [GOOD])
    yield lambda: check_levels(fitted, [GOOD])
    yield lambda: check_levels(swimmer, [_with(drive_signal=10 * BOX)])
    yield lambda: prepared(beam, [experiment_of(GOOD)])
    crushed = {"initial_state": "static_equilibrium", "initial_load_factor": "5000"}
    let_go = experiment_of(_with(drive_signal=None, metadata=crushed))
    yield lambda: simulable(beam, [let_go], SerialExecutor())
    yield _with(drive_signal=BOX[:, :1], channels=(CHAMBER,)).check_hasel_pair
    ripple = BOX + 20.0 * np.random.default_rng(1).normal(size=BOX.shape)
    yield lambda: list(_with(drive_signal=ripple).ripple)
    turned = np.mod(1.1 * TIME + 1e-9, 1) < 0.5
    between = _with(drive_signal=4500.0 * np.column_stack([turned, ~turned]))
    yield lambda: list(with_placed_switches(between).understood)
