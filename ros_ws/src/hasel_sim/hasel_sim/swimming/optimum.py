"""The frequency at which a swimmer is fastest, and how well it is known."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from hasel_sim.model import Model

WITHIN = 1.96
"""Standard errors on either side of a 95 % interval."""


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
