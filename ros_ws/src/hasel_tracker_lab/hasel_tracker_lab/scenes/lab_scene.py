# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A scene: water or a textured ground, swimmers, other blue things, shadows, reflections, and one camera."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

import cv2
import numpy as np

from hasel_tracker_lab.rendering.camera_model import compress
from hasel_tracker_lab.scenes.lab_swimmer import NAVY, LabSwimmer
from hasel_tracker_lab.scenes.lab_things import Thing
from hasel_tracker_lab.scenes.painting import Canvas

WATER = (185.0, 190.0, 182.0)
SUB_EXPOSURES = 3
FLICKER_HZ = 7.3


@dataclass(frozen=True)
class LabCamera:
    """blur_px: of the optics; exposure: factor on the light; noise_levels: of the sensor; bayer: one colour per
    pixel, interpolated; half_colour: 4:2:0; jpeg_quality: 0 for none."""

    blur_px: float = 0.7
    exposure: float = 1.0
    noise_levels: float = 2.5
    bayer: bool = True
    half_colour: bool = True
    jpeg_quality: int = 0

    def take(self, light: np.ndarray, random: np.random.Generator) -> np.ndarray:
        """An 8-bit BGR picture of the light (float32, BGR)."""
        light = cv2.GaussianBlur(light, (0, 0), self.blur_px) if self.blur_px else light
        light = light * self.exposure
        if self.bayer:
            mosaic = np.empty(light.shape[:2], np.float32)
            for row, column, channel in ((0, 0, 2), (0, 1, 1), (1, 0, 1), (1, 1, 0)):
                mosaic[row::2, column::2] = light[row::2, column::2, channel]
            mosaic += np.float32(random.normal(0.0, self.noise_levels, mosaic.shape))
            raw = np.clip(np.rint(mosaic), 0, 255).astype(np.uint8)
            image = cv2.demosaicing(raw, cv2.COLOR_BayerBG2BGR)  # OpenCV names the pattern by its second row
        else:
            noisy = light + random.normal(0.0, self.noise_levels, light.shape)
            image = np.clip(np.rint(noisy), 0, 255).astype(np.uint8)
        if self.jpeg_quality:
            return compress(image, self.jpeg_quality)
        if self.half_colour:
            image = _half_colour(image)
        return image


def _half_colour(image: np.ndarray) -> np.ndarray:
    """Keep luma in full and the mean colour of every two by two pixels (4:2:0, sited in their middle)."""
    parts = cv2.cvtColor(image, cv2.COLOR_BGR2YCrCb)
    height, width = image.shape[:2]
    colour = cv2.resize(parts[..., 1:], (width // 2, height // 2), interpolation=cv2.INTER_AREA)
    parts[..., 1:] = cv2.resize(colour, (width, height), interpolation=cv2.INTER_LINEAR)
    return cv2.cvtColor(parts, cv2.COLOR_YCrCb2BGR)


@dataclass(frozen=True)
class LabFrame:
    """A picture (8-bit BGR), its time [s], the true dots (m, 2) [px] in the mean of the exposure,
    which of them are in view (m,), the true sin θ, and the body's centre line (k, 2) [px]."""

    image: np.ndarray
    time_s: float
    dots_px: np.ndarray
    seen: np.ndarray
    sin_theta: float
    centre_line_px: np.ndarray


@dataclass(frozen=True)
class BlueDot:
    """Another blue dot: where at time zero [px], radius [px], velocity [px/s]."""

    x: float
    y: float
    radius: float = 12.0
    velocity: tuple[float, float] = (0.0, 0.0)
    colour: tuple[float, float, float] = NAVY


@dataclass(frozen=True)
class LabScene:
    """Everything before the camera. The first of `swimmers` is the one whose truth is given; there may be none.

    texture: contrast of a random ground in grey levels, 0 for plain water; grain_px: size of its grains. reflection:
    (y of the wall [px], strength): the first swimmer, mirrored, seen in a pane before it. things: what lies over the
    swimmers. shadow: share of light that the swimmer's shadow takes. flicker: by which share the light goes up and down
    at FLICKER_HZ.
    """

    swimmers: tuple[LabSwimmer, ...] = (LabSwimmer(),)
    dots: tuple[BlueDot, ...] = ()
    camera: LabCamera = field(default_factory=LabCamera)
    size_px: tuple[int, int] = (1280, 720)
    frame_rate_hz: float = 120.0
    exposure_s: float = 0.002
    water: tuple[float, float, float] = WATER
    texture: float = 0.0
    grain_px: float = 7.0
    light_fall: float = 0.25
    shadow: float = 0.2
    reflection: tuple[float, float] | None = None
    things: tuple[Thing, ...] = ()
    flicker: float = 0.0
    seed: int = 1

    def frames(self, count: int) -> Iterator[LabFrame]:
        """The first `count` frames."""
        random = np.random.default_rng(self.seed)
        for index in range(count):
            yield self.frame(index / self.frame_rate_hz, random)

    def frame(self, time_s: float, random: np.random.Generator | None = None) -> LabFrame:
        """The frame whose exposure is centred about a time."""
        random = random or np.random.default_rng(self.seed)
        moments = [time_s]
        if self.exposure_s:
            moments = time_s + self.exposure_s * ((np.arange(SUB_EXPOSURES) + 0.5) / SUB_EXPOSURES - 0.5)
        light = sum(self._light(moment) for moment in moments) / len(moments)
        image = self.camera.take(light, random)  # type: ignore[arg-type]
        if not self.swimmers:
            nothing = np.full((3, 2), np.nan)
            return LabFrame(image, time_s, nothing, np.zeros(3, bool), np.nan, nothing)
        swimmer = self.swimmers[0]
        dots = np.mean([swimmer.dots(moment) for moment in moments], axis=0)
        radius, size = swimmer.dot_radius_px, np.array(self.size_px)
        inside = ((dots > radius) & (dots < size - 1 - radius)).all(axis=1)
        seen = inside & ~swimmer.covered(time_s) & ~self._under_things(dots, radius, time_s)
        return LabFrame(image, time_s, dots, seen, _sine(dots), swimmer.centre_line(time_s))

    @cached_property
    def _ground(self) -> np.ndarray:
        width, height = self.size_px
        light = np.full((height, width, 3), self.water, np.float32)
        if self.texture:
            random = np.random.default_rng(self.seed + 100)
            grain = np.zeros((height, width), np.float32)
            for scale in (1.0, 2.7, 7.0):
                rough = random.normal(size=(height, width)).astype(np.float32)
                rough = cv2.GaussianBlur(rough, (0, 0), self.grain_px * scale / 2.0)
                grain += rough / rough.std() / np.sqrt(3.0)
            tint = np.array([0.85, 1.0, 1.1], np.float32)
            light += self.texture * grain[..., None] * tint
        across = np.linspace(0.0, 1.0, width, dtype=np.float32)[None, :]
        down = np.linspace(0.0, 1.0, height, dtype=np.float32)[:, None]
        return np.clip(light * (1.0 - self.light_fall * (0.6 * across + 0.4 * down))[..., None], 3.0, 250.0)

    def _light(self, time_s: float) -> np.ndarray:
        canvas = Canvas(self._ground)
        for swimmer in self.swimmers:
            if self.shadow:
                line = swimmer.centre_line(time_s) + [9.0, 14.0]
                around = np.vstack([line - [0.0, 20.0], (line + [0.0, 20.0])[::-1]])
                canvas.shade(around, 9.0, self.shadow)
        for swimmer in self.swimmers:
            swimmer.paint(canvas, time_s)
        if self.reflection is not None and self.swimmers:
            image, strength = self.swimmers[0].mirrored_at(*self.reflection)
            image.paint(canvas, time_s, strength)
        for dot in self.dots:
            centre = np.array([dot.x, dot.y]) + np.multiply(dot.velocity, time_s)
            canvas.disc(centre, dot.radius, dot.colour)
        for thing in self.things:
            thing.paint(canvas, time_s)
        return canvas.picture * (1.0 + self.flicker * np.sin(2.0 * np.pi * FLICKER_HZ * time_s))

    def _under_things(self, dots: np.ndarray, radius: float, time_s: float) -> np.ndarray:
        """Which dots (m,) something else lies over, be it their rim alone."""
        hiding = [thing for thing in self.things if thing.covers]
        if not hiding:
            return np.zeros(len(dots), bool)
        canvas = Canvas(np.zeros((*self.size_px[::-1], 3)))
        for thing in hiding:
            thing.paint(canvas, time_s)
        rows, columns = np.nonzero(canvas.picture.max(axis=2) > 1.0)
        return np.array([bool((np.hypot(columns - x, rows - y) < radius + 1.0).any()) for x, y in dots])


def _sine(dots: np.ndarray) -> float:
    if len(dots) < 3:
        return float("nan")
    inner = (len(dots) - 1) / 2
    middle = 0.5 * (dots[int(np.floor(inner))] + dots[int(np.ceil(inner))])
    front, rear = (middle - dots[0]) * [1, -1], (dots[-1] - middle) * [1, -1]
    return float((front[0] * rear[1] - front[1] * rear[0]) / np.hypot(*front) / np.hypot(*rear))
