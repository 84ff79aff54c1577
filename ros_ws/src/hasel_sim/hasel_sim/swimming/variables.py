"""What a search for a better swimmer may change: the boxes of its two muscles, its outline, constants of its file."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from hasel_common.names import nearest_name

from hasel_sim.errors import SimulationError
from hasel_sim.mesh.outline import half_height
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
