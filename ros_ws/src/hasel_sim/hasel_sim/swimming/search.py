# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The search for a better swimmer: what may change, what its shape has to keep to, what is sought, what was tried."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from hasel_common.names import nearest_name
from scipy.integrate import trapezoid

from hasel_sim.errors import SimulationError
from hasel_sim.mesh.body_mesh import half_height
from hasel_sim.model import Model
from hasel_sim.model.model_parameters import REST_CONTRACTION, constants, outline_names
from hasel_sim.swimming.boxes import Boxes

Range = tuple[float, float]

WAVEFORM: dict[str, Range] = {
    "first": (0.4, 1.0),
    "second": (0.4, 1.0),
    "duty": (0.2, 1.0),
    "phase": (0.25, 0.75),
}
"""The numbers of the boxes and how far they may go; voltages as shares of the largest."""
OUTLINE = "outline"
HALF_OR_DOUBLE: Range = (0.5, 2.0)
"""How far a constant of the body may go where nothing else is said, and the outline at every place, over the start."""
_VOLTAGES = ("first", "second")
LARGEST = "body.outline.largest_half_height_m"
_THICKNESS = "body.spine.thickness_m"
_COVER = 1.1
"""Height of the body over its spine's thickness, at least."""
_STATIONS = np.linspace(0.0, 1.0, 41)
GOALS = ("speed", "cost")
_REACHED = np.radians(0.1)
"""How far [rad, rad/s] a turning or heading may be from what is wanted."""


@dataclass(frozen=True)
class Variables:
    """Numbers x of about 1 and what they stand for: boxes, and values of the model's parameters `names`, linear in x.

    vary: numbers of the boxes, `outline` (its height at as many places as it has coefficients, over the start's) and
    paths of constants (over their start); ranges: of some of them, voltages in V; largest: voltage [V].
    """

    model: Model
    boxes: Boxes
    vary: tuple[str, ...]
    largest: float
    ranges: Mapping[str, Range] = field(default_factory=dict)

    def __post_init__(self) -> None:
        known = [
            *WAVEFORM,
            *([OUTLINE] if self._outline else []),
            *(name for name in constants(self.model.description) if not name.endswith(REST_CONTRACTION)),
        ]
        for name in self.vary:
            if name not in known:
                raise SimulationError(
                    f"'{name}' cannot be varied; expected some of {', '.join(WAVEFORM)}, {OUTLINE} or constants of the "
                    f"model file: {nearest_name(name, known)}"
                )
        if not self.vary or len(set(self.vary)) < len(self.vary):
            raise SimulationError(
                f"what may vary is {', '.join(self.vary) or 'nothing'}; expected each name once: name some"
            )
        if OUTLINE in self.vary and (LARGEST in self.vary or set(self._outline) & set(self.vary)):
            raise SimulationError(
                f"{OUTLINE} is varied beside {LARGEST} or single coefficients; expected one of them, as the outline "
                "sets all: leave the others out"
            )
        for name, (low, high) in self.ranges.items():
            if name == OUTLINE or name not in self.vary or not low < high:
                raise SimulationError(
                    f"{name} is given the range {low:g} to {high:g}; expected an ascending one, of something that is "
                    "varied and not the outline: correct it"
                )
        for name, value, (low, high) in zip(self._entries, self.start, self.bounds, strict=True):
            if not low - 1e-9 <= value <= high + 1e-9:
                unit = self._scale(name)
                raise SimulationError(
                    f"{name} starts at {value * unit:.5g}; expected {low * unit:.5g} to {high * unit:.5g}: start from "
                    "another value, or widen its range or the largest voltage"
                )

    @property
    def _outline(self) -> tuple[str, ...]:
        return outline_names(self.model.description.body)

    @property
    def _entries(self) -> list[str]:
        """The name that each number of x belongs to."""
        return [name for one in self.vary for name in [one] * (len(self._outline) if one == OUTLINE else 1)]

    @property
    def names(self) -> tuple[str, ...]:
        """The model's parameters that the numbers set."""
        own = [self._outline if name == OUTLINE else (name,) for name in self.vary if name not in WAVEFORM]
        return tuple(name for part in own for name in part)

    @cached_property
    def freed(self) -> Model:
        """The model with these as parameters, at the start."""
        return self.model.with_freed(*self.names)

    def _scale(self, name: str) -> float:
        """What a 1 in x stands for, in the unit of the name."""
        if name in WAVEFORM:
            return self.largest if name in _VOLTAGES else 1.0
        return 1.0 if name == OUTLINE else self.freed.values[name]

    @cached_property
    def start(self) -> np.ndarray:
        """x of the start."""
        return np.array(
            [getattr(self.boxes, n) / self._scale(n) if n in WAVEFORM else 1.0 for n in self._entries]
        )

    @cached_property
    def bounds(self) -> list[Range]:
        """Ranges of x."""
        out = []
        for name in self._entries:
            low, high = WAVEFORM.get(name, HALF_OR_DOUBLE)
            if name in self.ranges:
                ends = [end / self._scale(name) for end in self.ranges[name]]
                low, high = min(ends), max(ends)
            out.append((low, high))
        return out

    @property
    def of_waveform(self) -> list[int]:
        """Which of the numbers are those of the boxes."""
        return [place for place, name in enumerate(self._entries) if name in WAVEFORM]

    def drive(self, x: np.ndarray) -> Boxes:
        """The boxes that x stands for."""
        found = {n: float(v) * self._scale(n) for n, v in zip(self._entries, x, strict=True) if n in WAVEFORM}
        return replace(self.boxes, **found)

    @cached_property
    def matrix(self) -> np.ndarray:
        """Values of the parameters `names` by x, [names, x]."""
        entries, rows = self._entries, []
        body = self.freed.described.body
        for name in self.vary:
            if name in WAVEFORM:
                continue
            columns = [place for place, entry in enumerate(entries) if entry == name]
            block = np.zeros((len(columns), len(entries)))
            if name == OUTLINE:
                at = _places(len(columns))
                heights = half_height(np.array(body.coefficients), 1.0, at)
                block[:, columns] = np.linalg.inv(np.vander(at, increasing=True)) * heights
            else:
                block[0, columns] = self._scale(name)
            rows.append(block)
        return np.concatenate(rows) if rows else np.zeros((0, len(entries)))

    def values(self, x: np.ndarray) -> dict[str, float]:
        """The values of the parameters `names`."""
        return dict(zip(self.names, (self.matrix @ x).tolist(), strict=True))

    def text(self, x: np.ndarray) -> str:
        """What of the body x stands for, in one line; empty where only the boxes vary."""
        parts = []
        for name in self.vary:
            own = [v for entry, v in zip(self._entries, x, strict=True) if entry == name]
            if name == OUTLINE:
                parts.append(f"heights over the start's {' '.join(f'{v:.2f}' for v in own)}")
            elif name not in WAVEFORM:
                parts.append(f"{name} {own[0] * self._scale(name):.4g}")
        return ", ".join(parts)


def _places(count: int) -> np.ndarray:
    """Where along the body, 0 to 1, the outline's height is varied: dense at the ends, as polynomials want it."""
    return np.array([0.5]) if count == 1 else 0.5 - 0.5 * np.cos(np.pi * np.arange(count) / (count - 1))


def shape_limits(variables: Variables) -> list[dict[str, Any]]:
    """Constraints of x, for a minimiser: an outline keeps its area and half to twice its height, no spine is bare."""

    def heights(x: np.ndarray) -> tuple[np.ndarray, float]:
        """Heights [m] along the body, and the spine's thickness [m]."""
        body = variables.freed.with_values(variables.values(x)).described.body
        return 2 * body.half_heights(_STATIONS), body.spine_thickness_m

    def cover(x: np.ndarray) -> np.ndarray:
        height, thickness = heights(x)
        return (height - _COVER * thickness) / height.max()

    out: list[dict[str, Any]] = []
    start = heights(variables.start)[0]
    if OUTLINE in variables.vary:
        low, high = HALF_OR_DOUBLE
        out = [
            {"type": "eq", "fun": lambda x: trapezoid(heights(x)[0]) / trapezoid(start) - 1.0},
            {"type": "ineq", "fun": lambda x: heights(x)[0] / start - low},
            {"type": "ineq", "fun": lambda x: high - heights(x)[0] / start},
        ]
    if {OUTLINE, LARGEST, _THICKNESS, "body.height_m"} & set(variables.vary):
        out.append({"type": "ineq", "fun": cover})
    return out


@dataclass(frozen=True)
class Task:
    """What is sought: the fastest swim, or the one with the least cost of transport.

    turning: at a rate [rad/s]; heading: the body points there at the end, to the left of its start [rad]; either as it
    comes for None. vary, ranges: as of `Variables`; largest: voltage [V]; duration: of the swims that are tried [s].
    """

    goal: str = "speed"
    turning: float | None = None
    vary: tuple[str, ...] = ("first", "second")
    largest: float = 5500.0
    duration: float = 4.0
    heading: float | None = None
    ranges: Mapping[str, Range] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.goal not in GOALS:
            raise SimulationError(f"'{self.goal}' is no goal; expected one of {', '.join(GOALS)}")
        if self.turning is not None and self.heading is not None:
            raise SimulationError(
                "both turning and heading are given; expected one of them, since the one sets the other: leave one out"
            )


@dataclass(frozen=True)
class Tried:
    """A swimmer with what it came to.

    speed [m/s], turning [rad/s], heading at the end [rad], power [W] and the mass it moved [kg]; body: what of it was
    varied, in words; values: of the parameters that were.
    """

    drive: Boxes
    speed: float
    turning: float
    power: float
    mass: float
    heading: float = 0.0
    body: str = ""
    values: dict[str, float] = field(default_factory=dict, compare=False)

    @property
    def cost_of_transport(self) -> float:
        """Work per mass and distance [J/(kg m)]."""
        return self.power / (self.mass * self.speed) if self.speed > 0 else np.inf

    def __str__(self) -> str:
        body = f", {self.body}" if self.body else ""
        return (
            f"{self.drive}, duty {self.drive.duty:.3f}, phase {self.drive.phase:.3f}{body}: "
            f"{1e3 * self.speed:.2f} mm/s, {np.degrees(self.turning):+.3f}°/s, heading "
            f"{np.degrees(self.heading):+.2f}°, {self.cost_of_transport:.3g} J/(kg m)"
        )


@dataclass(frozen=True)
class BestSwim:
    """The start and the best, and everything that was tried on the way."""

    start: Tried
    best: Tried
    tried: tuple[Tried, ...] = field(repr=False)
    task: Task

    @property
    def missed(self) -> str:
        """A sentence about a turning or heading that was asked for and is not reached; empty where all is."""
        for name, unit in (("turning", "°/s"), ("heading", "°")):
            wanted, reached = getattr(self.task, name), getattr(self.best, name)
            if wanted is not None and abs(reached - wanted) > _REACHED:
                return (
                    f"The {name} of {np.degrees(wanted):g}{unit} is not reached, only {np.degrees(reached):.3g}{unit}: "
                    "let more vary, in wider ranges or for longer."
                )
        return ""

    def __str__(self) -> str:
        told = f"from {self.start}\nto   {self.best}\nafter {len(self.tried)} swims with gradients."
        return f"{told} {self.missed}".rstrip()

    def improved(self, model: Model) -> Model:
        """A model with the body that was found, as a file of its own would describe it."""
        changed = model.with_freed(*self.best.values).with_values(self.best.values)
        return changed.with_constants_settled(
            *(name for name in self.best.values if name not in model.parameters)
        )
