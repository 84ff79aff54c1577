# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The drawn swimmer: what it looks like (lengths in m, colours as BGR), and its centre line over time."""

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from scipy.interpolate import CubicSpline

STATION_COUNT = 96


@dataclass(frozen=True)
class BodyShape:
    """The default swimmer's proportions; stations are distances from the nose along the centre line."""

    body_length_m: float = 0.160
    fin_length_m: float = 0.030
    spine_thickness_m: float = 0.001
    half_height_scale_m: float = 0.0075
    half_height_coefficients: tuple[float, ...] = (
        0.3,
        5.13847447,
        -13.84583811,
        19.51736782,
        -18.6011192,
        7.61111502,
    )
    muscle_stations_m: tuple[float, float] = (0.052, 0.152)
    marker_stations_m: tuple[float, float, float] = (0.005, 0.094, 0.190)
    marker_radius_m: float = 0.002
    body_colour: tuple[int, int, int] = (214, 222, 226)
    spine_colour: tuple[int, int, int] = (120, 128, 132)
    marker_colour: tuple[int, int, int] = (168, 72, 22)

    @property
    def total_length_m(self) -> float:
        """Length from the nose to the tip of the fin [m]."""
        return self.body_length_m + self.fin_length_m

    def half_height(self, stations_m: np.ndarray) -> np.ndarray:
        """Half height of the soft body [m] at the stations, zero behind the body."""
        relative = np.asarray(stations_m) / self.body_length_m
        height = self.half_height_scale_m * np.polynomial.polynomial.polyval(
            relative, self.half_height_coefficients
        )
        return np.where(relative <= 1.0, height, 0.0)


class RenderedMotion(Protocol):
    """Anything that can say where the centre line is."""

    @property
    def duration_s(self) -> float:
        """How long it lasts [s]."""

    def centre_line(self, time_s: float) -> np.ndarray:
        """Centre line [m] from nose to fin tip at equal material distances, shape (n, 2), y up."""


@dataclass(frozen=True)
class BendingMotion:
    """A body that bends with uniform curvature over its muscles and drifts along its axis.

    The angle between the stiff head and the tail is `amplitude_rad` · sin(2π f t), started smoothly within
    about half a period after `rest_s` at rest.
    """

    amplitude_rad: float = 0.6
    frequency_hz: float = 2.0
    duration_s: float = 1.0
    rest_s: float = 0.0
    drift_m_per_s: float = 0.0
    heading_rad: float = 0.0
    shape: BodyShape = field(default_factory=BodyShape)

    def bend(self, time_s: float) -> float:
        """Angle from head to tail [rad]."""
        active = max(time_s - self.rest_s, 0.0)
        cycles = self.frequency_hz * active
        return self.amplitude_rad * np.sin(2.0 * np.pi * cycles) * (1.0 - np.exp(-((4.0 * cycles) ** 2)))

    def line_when_bent(self, bend_rad: float) -> np.ndarray:
        """Centre line [m] about the origin for an angle from head to tail, shape (STATION_COUNT, 2)."""
        stations = np.linspace(0.0, self.shape.total_length_m, STATION_COUNT)
        start, end = self.shape.muscle_stations_m
        share = np.clip((stations - start) / (end - start), 0.0, 1.0)
        # Half of the bend turns the head the other way, so that the body stays in view.
        slope = bend_rad * (share - 0.5) + self.heading_rad
        middle_slope = 0.5 * (slope[1:] + slope[:-1])
        steps = stations[1] * np.stack([np.cos(middle_slope), np.sin(middle_slope)], axis=1)
        line = np.vstack([np.zeros(2), np.cumsum(steps, axis=0)])
        return line - line.mean(axis=0)

    def markers_when_bent(self, bend_rad: float) -> np.ndarray:
        """Marker positions [m], shape (3, 2)."""
        line = self.line_when_bent(bend_rad)
        return points_at(line, np.array(self.shape.marker_stations_m), self.shape.total_length_m)

    def centre_line(self, time_s: float) -> np.ndarray:
        drift = self.drift_m_per_s * time_s * np.array([np.cos(self.heading_rad), np.sin(self.heading_rad)])
        return self.line_when_bent(self.bend(time_s)) - drift


@dataclass(frozen=True)
class SampledMotion:
    """A motion known at some times as centre-line points; linear in between.

    times_s has shape (n,), lines_m shape (n, points, 2): nose to fin tip at equal material distances.
    """

    times_s: np.ndarray
    lines_m: np.ndarray

    @property
    def duration_s(self) -> float:
        """Time from the first to the last sample [s]."""
        return float(self.times_s[-1] - self.times_s[0])

    def centre_line(self, time_s: float) -> np.ndarray:
        wanted = self.times_s[0] + time_s
        after = int(np.clip(np.searchsorted(self.times_s, wanted), 1, len(self.times_s) - 1))
        before = after - 1
        span = self.times_s[after] - self.times_s[before]
        share = np.clip((wanted - self.times_s[before]) / span, 0.0, 1.0)
        return (1.0 - share) * self.lines_m[before] + share * self.lines_m[after]


def line_through_markers(markers_m: np.ndarray, shape: BodyShape) -> np.ndarray:
    """Smooth centre line, shape (n, 2), through the head, middle and tail markers, shape (3, 2) [m]."""
    spline = CubicSpline(np.array(shape.marker_stations_m), markers_m, bc_type="natural")
    return spline(np.linspace(0.0, shape.total_length_m, STATION_COUNT))


def points_at(line_m: np.ndarray, stations_m: np.ndarray, total_length_m: float) -> np.ndarray:
    """Points on a centre line [m] at material stations [m], shape (len(stations), 2)."""
    known = np.linspace(0.0, total_length_m, len(line_m))
    return CubicSpline(known, line_m)(np.asarray(stations_m))
