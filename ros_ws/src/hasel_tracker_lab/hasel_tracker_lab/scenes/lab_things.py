# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What else gets into a picture: cables, hands, bubbles, glare; each moves with a velocity [px/s]."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from hasel_tracker_lab.scenes.painting import Canvas

LINE_POINTS = 60
SKIN, BLUE_GLOVE, BLUE_CABLE, BLACK = (
    (140.0, 165.0, 215.0),
    (165.0, 80.0, 35.0),
    (160.0, 60.0, 20.0),
    (35.0, 33.0, 30.0),
)
FINGERS = ((-0.9, 0.55, 0.9), (-0.3, 0.15, 1.15), (0.05, -0.05, 1.25), (0.4, -0.2, 1.1), (0.75, -0.4, 0.9))


class Thing(Protocol):
    """Painted over the swimmers. `covers`: whether what lies under it cannot be seen."""

    @property
    def covers(self) -> bool: ...

    def paint(self, canvas: Canvas, time_s: float) -> None: ...


@dataclass(frozen=True)
class Cable:
    """A cable or tether, bowed between two points [px], of so many px width."""

    first: tuple[float, float]
    last: tuple[float, float]
    width: float = 4.0
    bow: float = 0.0
    colour: tuple[float, float, float] = BLACK
    velocity: tuple[float, float] = (0.0, 0.0)
    covers: bool = True

    def paint(self, canvas: Canvas, time_s: float) -> None:
        """Paint a band along a parabola."""
        share = np.linspace(0.0, 1.0, LINE_POINTS)[:, None]
        along = np.subtract(self.last, self.first)
        side = np.array([-along[1], along[0]]) * self.bow
        line = self.first + share * along + 4.0 * share * (1.0 - share) * side
        line = line + np.multiply(self.velocity, time_s)
        canvas.strip(line, np.full(LINE_POINTS, 0.5 * self.width), self.colour)


@dataclass(frozen=True)
class Hand:
    """A palm with five fingers at the end of an arm that comes from where it points away from."""

    palm: tuple[float, float]
    heading_rad: float = 0.0
    size: float = 90.0
    colour: tuple[float, float, float] = SKIN
    velocity: tuple[float, float] = (0.0, 0.0)
    covers: bool = True

    def paint(self, canvas: Canvas, time_s: float) -> None:
        """Paint arm, palm and fingers."""
        palm = np.add(self.palm, np.multiply(self.velocity, time_s))
        ahead = np.array([np.cos(self.heading_rad), -np.sin(self.heading_rad)])
        side = np.array([-ahead[1], ahead[0]])
        canvas.disc(palm, 0.62 * self.size, self.colour)
        self._limb(canvas, palm, palm - 9.0 * self.size * ahead, 0.42)
        for place, spread, reach in FINGERS:
            root = palm + self.size * (0.35 * ahead + 0.5 * place * side)
            tip = root + self.size * reach * (ahead - spread * side)
            self._limb(canvas, root, tip, 0.14)
            canvas.disc(tip, 0.14 * self.size, self.colour)

    def _limb(self, canvas: Canvas, first: np.ndarray, last: np.ndarray, half_width: float) -> None:
        line = np.linspace(first, last, LINE_POINTS)
        canvas.strip(line, np.full(LINE_POINTS, half_width * self.size), self.colour)


@dataclass(frozen=True)
class Bubble:
    """A round thing, more or less transparent."""

    centre: tuple[float, float]
    radius: float
    colour: tuple[float, float, float] = (235.0, 235.0, 230.0)
    strength: float = 1.0
    velocity: tuple[float, float] = (0.0, 0.0)
    covers: bool = True

    def paint(self, canvas: Canvas, time_s: float) -> None:
        """Paint a disc."""
        canvas.disc(
            np.add(self.centre, np.multiply(self.velocity, time_s)), self.radius, self.colour, self.strength
        )


@dataclass(frozen=True)
class Glare:
    """A lamp's soft reflection that takes the picture towards white; it hides nothing wholly."""

    centre: tuple[float, float]
    radius: float
    strength: float
    velocity: tuple[float, float] = (0.0, 0.0)
    covers: bool = False

    def paint(self, canvas: Canvas, time_s: float) -> None:
        """Lighten the picture by a Gaussian."""
        x, y = np.add(self.centre, np.multiply(self.velocity, time_s))
        rows, columns = np.ogrid[: canvas.picture.shape[0], : canvas.picture.shape[1]]
        share = self.strength * np.exp(-0.5 * ((columns - x) ** 2 + (rows - y) ** 2) / self.radius**2)
        canvas.picture += share[..., None].astype(np.float32) * (255.0 - canvas.picture)
