# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A swimmer in the laboratory's pictures: how it bends, where its dots are, how it is painted (lengths in px)."""

from dataclasses import dataclass, field, replace

import numpy as np

from hasel_tracker_lab.scenes.painting import Canvas

SEGMENTS = 160
RISE_S = 0.03
NAVY, GREY_BODY, DARK = (150.0, 60.0, 25.0), (205.0, 215.0, 220.0), (45.0, 42.0, 40.0)


@dataclass(frozen=True)
class LabSwimmer:
    """A body of constant length whose curvature is a wave that runs from head to tail.

    start_px: the nose at time zero; heading_rad: where the body points from head to tail, anticlockwise with y up;
    drift_px_s: velocity of the nose, y down; bend_rad: the largest turn from head to tail; stations: of the dots, 0
    (nose) to 1 (tip of the fin); taper: half the width at the fin's root as a share of that at the shoulder.
    marked: whether the dots are there at all; tags: AprilTags instead.
    hidden: (dot, from [s], to [s]) during which a hand, a bubble or a tether covers a dot, in `cover_colour`.
    """

    length_px: float = 640.0
    start_px: tuple[float, float] = (320.0, 360.0)
    heading_rad: float = 0.0
    drift_px_s: tuple[float, float] = (0.0, 0.0)
    bend_rad: float = 0.9
    frequency_hz: float = 2.0
    phase_lag_rad: float = 0.6
    rest_s: float = 0.0
    stations: tuple[float, ...] = (0.05, 0.5, 0.97)
    dot_radius_px: float = 12.0
    dot_colour: tuple[float, float, float] = NAVY
    body_colour: tuple[float, float, float] = GREY_BODY
    half_width_px: float = 34.0
    taper: float = 0.4
    fin_from: float = 0.82
    fin_half_width_px: float = 3.0
    electrodes: bool = False
    gloss: float = 0.0
    tags: bool = False
    marked: bool = True
    hidden: tuple[tuple[int, float, float], ...] = field(default=())
    cover_colour: tuple[float, float, float] = GREY_BODY

    def centre_line(self, time_s: float) -> np.ndarray:
        """Points from nose to tip [px], y down, shape (SEGMENTS + 1, 2)."""
        station = (np.arange(SEGMENTS) + 0.5) / SEGMENTS
        active = max(time_s - self.rest_s, 0.0)
        wave = np.sin(2 * np.pi * self.frequency_hz * active - self.phase_lag_rad * station)
        wave *= 1.0 - np.exp(-active / RISE_S)
        turn = self.heading_rad + np.cumsum(self.bend_rad * wave * 1.5 * station) / SEGMENTS
        steps = np.column_stack([np.cos(turn), -np.sin(turn)]) * self.length_px / SEGMENTS
        nose = np.add(self.start_px, np.multiply(self.drift_px_s, time_s))
        return nose + np.vstack([[0.0, 0.0], np.cumsum(steps, axis=0)])

    def dots(self, time_s: float) -> np.ndarray:
        """Centres of the dots [px], shape (m, 2)."""
        line, known = self.centre_line(time_s), np.linspace(0.0, 1.0, SEGMENTS + 1)
        return np.column_stack([np.interp(self.stations, known, line[:, axis]) for axis in (0, 1)])

    def covered(self, time_s: float) -> np.ndarray:
        """Which dots cannot be seen, shape (m,)."""
        away = {dot for dot, begin, end in self.hidden if begin <= time_s < end}
        return np.array([number in away for number in range(len(self.stations))])

    def mirrored_at(self, y_px: float, strength: float) -> "tuple[LabSwimmer, float]":
        """Its reflection in a wall along y [px], and how strongly that is seen."""
        x, y = self.start_px
        turned = replace(
            self,
            start_px=(x, 2 * y_px - y),
            heading_rad=-self.heading_rad,
            bend_rad=-self.bend_rad,
            drift_px_s=(self.drift_px_s[0], -self.drift_px_s[1]),
        )
        return turned, strength

    def paint(self, canvas: Canvas, time_s: float, strength: float = 1.0) -> None:
        """Paint body, fin, electrodes and dots."""
        line = self.centre_line(time_s)
        canvas.strip(line, self._half_width(np.linspace(0.0, 1.0, SEGMENTS + 1)), self.body_colour, strength)
        covered = self.covered(time_s)
        for number, centre in enumerate(self.dots(time_s)):
            if self.electrodes:
                self._electrodes(canvas, line, self.stations[number], strength)
            if self.tags:
                canvas.tag(centre, number, 2.4 * self.dot_radius_px, self.heading_rad)
            elif self.marked:
                self._dot(canvas, centre, strength)
            if covered[number]:
                canvas.disc(centre, 1.7 * self.dot_radius_px, self.cover_colour, 1.0)

    def _dot(self, canvas: Canvas, centre: np.ndarray, strength: float) -> None:
        canvas.disc(centre, self.dot_radius_px, self.dot_colour, strength)
        if self.gloss:
            corner = centre - 0.4 * self.dot_radius_px
            canvas.disc(corner, 0.3 * self.dot_radius_px, (255.0, 255.0, 255.0), self.gloss)

    def _half_width(self, station: np.ndarray) -> np.ndarray:
        nose = np.sqrt(np.clip(station / 0.06, 0.0, 1.0))
        body = (
            self.half_width_px
            * nose
            * (1.0 - (1.0 - self.taper) * np.clip(station / self.fin_from, 0.0, 1.0))
        )
        return np.where(station < self.fin_from, body, self.fin_half_width_px)

    def _electrodes(self, canvas: Canvas, line: np.ndarray, station: float, strength: float) -> None:
        """Dark bars across the body, a few pixels before and behind a dot."""
        gap = (self.dot_radius_px + 3.5) / self.length_px
        for begin, end in ((station - gap - 0.03, station - gap), (station + gap, station + gap + 0.03)):
            if begin >= 0.0 and end < self.fin_from:
                part = line[round(begin * SEGMENTS) : round(end * SEGMENTS) + 1]
                if len(part) > 1:
                    canvas.strip(part, np.full(len(part), 0.45 * self.half_width_px), DARK, strength)
