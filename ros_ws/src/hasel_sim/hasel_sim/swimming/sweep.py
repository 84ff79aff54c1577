# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Swims under many drives: in parallel, kept in a file as they end, so that a sweep that was broken off goes on.

Of their speeds: the frequency at which a swimmer is fastest, how well it is known, and the seed paper's figure.
"""

import csv
import hashlib
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor, as_completed
from dataclasses import astuple, dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from hasel_sim.errors import HaselSimError, ModelError
from hasel_sim.model import Model
from hasel_sim.model.model_file import model_text
from hasel_sim.parallel import side_by_side
from hasel_sim.simulate import simulate_many
from hasel_sim.swimming.boxes import Boxes
from hasel_sim.swimming.free_swim import check_swimmer, measured

if TYPE_CHECKING:
    from matplotlib.figure import Figure

WITHIN = 1.96
"""Standard errors on either side of a 95 % interval."""
COLOURS = ("#4b86b4", "#d9654b", "#3f8f6b", "#8a5fa8", "#c9a227", "#44505c")
MARKS = "osD^vP"


@dataclass(frozen=True)
class Optimum:
    """frequency [Hz] and speed [m/s] at the top; at_edge: whether the fastest of the sweep is its first or last.

    standard_error [Hz]: from the parameters'; None where none of them is known to be uncertain.
    """

    frequency: float
    speed: float
    at_edge: bool = False
    standard_error: float | None = None

    @property
    def interval(self) -> tuple[float, float] | None:
        """95 % interval of the frequency [Hz]."""
        if self.standard_error is None:
            return None
        return self.frequency - WITHIN * self.standard_error, self.frequency + WITHIN * self.standard_error

    def __str__(self) -> str:
        speed = f"{1e3 * self.speed:.3g} mm/s"
        if self.at_edge:
            return f"fastest at {self.frequency:g} Hz ({speed}), where the sweep ends: no optimum within it"
        known = "" if self.interval is None else " (95 % interval {:.2f} to {:.2f} Hz)".format(*self.interval)
        return f"optimum {self.frequency:.2f} Hz{known}, {speed}"


def optimum(frequencies: Sequence[float], speeds: Sequence[float]) -> Optimum | None:
    """The top of a sweep: the vertex of the parabola through the fastest and its neighbours; None without any speed."""
    f, u = np.asarray(frequencies, dtype=float), np.asarray(speeds, dtype=float)
    f, u = f[np.isfinite(u)], u[np.isfinite(u)]
    order = np.argsort(f)
    f, u = f[order], u[order]
    if len(f) == 0:
        return None
    best = int(np.argmax(u))
    if best in (0, len(f) - 1):
        return Optimum(float(f[best]), float(u[best]), at_edge=True)
    vertex, top = vertex_of(f[best - 1 : best + 2], u[best - 1 : best + 2])
    return Optimum(vertex, top)


def vertex_of(f: np.ndarray, u: np.ndarray) -> tuple[float, float]:
    """Place and height of the vertex of the parabola through three points."""
    centred = f - f[1]
    a, b, c = np.polyfit(centred, u, 2)
    place = -b / (2 * a)
    return float(f[1] + place), float(c + 0.5 * b * place)


def uncertain(model: Model) -> dict[str, float]:
    """Parameters that have a standard error, with it."""
    return {
        name: parameter.standard_error
        for name, parameter in model.parameters.items()
        if parameter.standard_error
    }


def standard_error_of(
    model: Model, found: Optimum, step: float, speeds: Callable[[list[tuple[Model, float]]], list[float]]
) -> float | None:
    """Standard error of the top's frequency [Hz] by the delta method, from the parameters' covariance.

    speeds: what a list of (model, frequency) swims at; step: distance [Hz] of the three frequencies around the top.
    Errors whose correlation the model does not know, such as those of data sheets, count as independent.
    """
    names = uncertain(model)
    if not names or found.at_edge:
        return None
    f = found.frequency + step * np.array([-1.0, 0.0, 1.0])
    ends = []
    for name, error in names.items():
        p = model.parameters[name]
        ends.append((min(p.value + error, p.upper), max(p.value - error, p.lower)))
    pairs = zip(names, ends, strict=True)
    models = [model.with_values({name: value}) for name, both in pairs for value in both]
    swum = np.array(speeds([(m, x) for m in models for x in f])).reshape(len(names), 2, 3)
    tops = np.array([[vertex_of(f, u)[0] for u in pair] for pair in swum])
    widths = np.array([above - below for above, below in ends])
    slopes = (tops[:, 0] - tops[:, 1]) / widths
    return float(np.sqrt(max(slopes @ model.covariance(tuple(names)) @ slopes, 0.0)))


@dataclass(frozen=True)
class Swam:
    """One line of a sweep: the drive and how the body swam; NaN throughout for a motion that could not be followed."""

    first_v: float
    second_v: float
    frequency_hz: float
    speed_m_per_s: float
    earlier_m_per_s: float
    distance_m: float
    heading_rad: float
    turning_rad_per_s: float
    power_w: float
    cost_of_transport_j_per_kg_m: float

    @property
    def has_settled(self) -> bool:
        """Whether the speed no longer changes by more than a twentieth between the last two windows."""
        return abs(self.speed_m_per_s - self.earlier_m_per_s) <= 0.05 * abs(self.speed_m_per_s)

    @property
    def drive(self) -> Boxes:
        """The drive."""
        return Boxes(self.first_v, self.second_v, self.frequency_hz)


def swim_together(model: Model, drives: Sequence[Boxes], duration: float) -> list[Swam]:
    """Swims side by side in one process."""
    cases = [(model, drive.run(model, duration)) for drive in drives]
    out = []
    for drive, result in zip(drives, simulate_many(cases, keep_shapes=True), strict=True):
        key = (drive.first, drive.second, drive.frequency)
        if isinstance(result, HaselSimError):
            out.append(Swam(*key, *[float("nan")] * (len(fields(Swam)) - len(key))))
            continue
        swim = measured(model, result, drive.frequency)
        ways = swim.distance, swim.heading, swim.turning
        out.append(Swam(*key, swim.speed, swim.earlier, *ways, swim.power, swim.cost_of_transport))
    return out


class SweepLedger:
    """The file of a sweep: a line per drive, written when it ends; only for one model and one duration [s]."""

    def __init__(self, path: Path, model: Model, duration: float) -> None:
        self.path = path
        self._key = f"#model: {fingerprint(model)}, duration_s: {duration:g}"
        self.known: dict[Boxes, Swam] = {}
        if path.exists():
            self._read()
        else:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(f"{self._key}\n{','.join(field.name for field in fields(Swam))}\n")

    def _read(self) -> None:
        text = self.path.read_text()
        lines = text.splitlines()
        if not lines or lines[0] != self._key:
            raise ModelError(
                f"'{self.path}' holds swims of another model or duration; expected one of these or none: name another "
                "--output, or remove it"
            )
        whole = lines if text.endswith("\n") else lines[:-1]
        for row in csv.reader(whole[2:]):
            swam = Swam(*map(float, row))
            self.known[swam.drive] = swam
        if whole is not lines:
            self.path.write_text("\n".join(whole) + "\n")

    def add(self, swam: Sequence[Swam]) -> None:
        """Keep further swims."""
        with self.path.open("a") as file:
            for one in swam:
                self.known[one.drive] = one
                file.write(",".join(repr(value) for value in astuple(one)) + "\n")


def fingerprint(model: Model) -> str:
    """What tells a model from another: of all that its file says but its name."""
    unnamed = model.description.model_copy(update={"name": ""})
    return hashlib.sha256(model_text(model, unnamed).encode()).hexdigest()[:16]


def check_drives(model: Model, drives: Sequence[Boxes], duration: float) -> None:
    """Refuse what cannot swim, or not so short, with a SimulationError."""
    check_swimmer(model)
    for drive in drives:
        drive.run(model, duration)


def sweep(
    pool: Executor,
    model: Model,
    drives: Sequence[Boxes],
    duration: float,
    ledger: SweepLedger | None = None,
    done: Callable[[int], None] = lambda count: None,
) -> list[Swam]:
    """Every drive's swim, in the order of the drives; done: called with how many have ended."""
    check_drives(model, drives, duration)
    known = dict(ledger.known) if ledger else {}
    missing = [drive for drive in dict.fromkeys(drives) if drive not in known]
    done(len(set(drives)) - len(missing))
    share = -(-len(missing) // getattr(pool, "workers", 1))
    batches = [pool.submit(swim_together, model, part, duration) for part in side_by_side(missing, share)]
    for batch in as_completed(batches):
        swam = batch.result()
        known |= {one.drive: one for one in swam}
        if ledger:
            ledger.add(swam)
        done(len([drive for drive in set(drives) if drive in known]))
    return [known[drive] for drive in drives]


def draw_speeds(
    title: str, curves: Mapping[str, Sequence[Swam]], optima: Mapping[str, Optimum | None]
) -> "Figure":
    """Speed [mm/s] over frequency [Hz], with each curve's optimum and its interval."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.5, 4.5), layout="constrained")
    axes = figure.add_subplot()
    for number, (label, swam) in enumerate(curves.items()):
        colour, mark = COLOURS[number % len(COLOURS)], MARKS[number % len(MARKS)]
        ordered = sorted(swam, key=lambda one: one.frequency_hz)
        f = np.array([one.frequency_hz for one in ordered])
        u = 1e3 * np.array([one.speed_m_per_s for one in ordered])
        axes.plot(f, u, mark, color=colour, linestyle="-", markersize=5, label=label)
        top = optima.get(label)
        if top is not None and not top.at_edge:
            axes.plot(
                top.frequency, 1e3 * top.speed, "*", color=colour, markeredgecolor="black", markersize=13
            )
            if top.interval:
                axes.axvspan(*top.interval, color=colour, alpha=0.12, linewidth=0)
    axes.axhline(0.0, color="#888888", linewidth=0.7)
    axes.set_xlabel("frequency of the boxes [Hz]")
    axes.set_ylabel("swimming speed [mm/s]")
    axes.set_title(title)
    axes.legend(frameon=False)
    axes.grid(color="#dddddd", linewidth=0.5)
    return figure
