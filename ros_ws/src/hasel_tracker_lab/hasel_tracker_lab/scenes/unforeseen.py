# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Scenes that nobody made a rule for, drawn at random: what a laboratory's day brings."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from hasel_tracker_lab.scenes.lab_scene import BlueDot, LabCamera, LabScene
from hasel_tracker_lab.scenes.lab_swimmer import LabSwimmer
from hasel_tracker_lab.scenes.lab_things import BLUE_CABLE, BLUE_GLOVE, SKIN, Bubble, Cable, Glare, Hand
from hasel_tracker_lab.scenes.scene_catalogue import LabCase

FRAMES = 24
SIZE = np.array([1280.0, 720.0])


def _swimmer(random: np.random.Generator) -> LabSwimmer:
    """Anywhere in the picture, of any heading, frequency, size and drift."""
    heading, length = random.uniform(-np.pi, np.pi), random.uniform(420.0, 600.0)
    along = np.array([np.cos(heading), -np.sin(heading)])
    start = 0.5 * SIZE + random.uniform(-60, 60, 2) - 0.5 * length * along
    return LabSwimmer(
        length_px=length,
        start_px=tuple(start),
        heading_rad=heading,
        drift_px_s=tuple(random.uniform(-40, 40, 2)),
        bend_rad=random.uniform(0.3, 0.9),
        frequency_hz=random.uniform(0.8, 3.5),
        electrodes=bool(random.integers(2)),
    )


def _somewhere(random: np.random.Generator) -> tuple[float, float]:
    return tuple(random.uniform([60, 60], SIZE - 60))


def _velocity(random: np.random.Generator, speed: float) -> tuple[float, float]:
    turn = random.uniform(-np.pi, np.pi)
    return speed * float(np.cos(turn)), speed * float(np.sin(turn))


def _drawn(make: Callable[[np.random.Generator, LabScene], LabScene]) -> Callable[[int], LabScene]:
    def scene(seed: int) -> LabScene:
        random = np.random.default_rng(1000 + seed)
        plain = LabScene((_swimmer(random),), exposure_s=0.0, frame_rate_hz=60.0, seed=seed)
        return make(random, plain)

    return scene


def _light_from_one_side(random: np.random.Generator, plain: LabScene) -> LabScene:
    return replace(plain, light_fall=random.uniform(0.6, 0.85), shadow=random.uniform(0.2, 0.5))


def _hand(colour: tuple[float, float, float]) -> Callable[[np.random.Generator, LabScene], LabScene]:
    def make(random: np.random.Generator, plain: LabScene) -> LabScene:
        heading = random.uniform(-np.pi, np.pi)
        speed = random.uniform(200, 900)
        ahead = np.array([np.cos(heading), -np.sin(heading)])
        begin = 0.5 * SIZE + random.uniform(-200, 200, 2) - ahead * random.uniform(150, 400)
        hand = Hand(tuple(begin), heading, random.uniform(60, 110), colour, tuple(speed * ahead))
        return replace(plain, things=(hand,))

    return make


def _blue_cable(random: np.random.Generator, plain: LabScene) -> LabScene:
    cables = tuple(
        Cable(
            _somewhere(random),
            _somewhere(random),
            random.uniform(4, 26),
            random.uniform(-0.3, 0.3),
            BLUE_CABLE,
        )
        for _ in range(2)
    )
    return replace(plain, things=cables)


def _glare(random: np.random.Generator, plain: LabScene) -> LabScene:
    spots = tuple(
        Glare(
            _somewhere(random),
            random.uniform(25, 140),
            random.uniform(0.4, 1.0),
            _velocity(random, random.uniform(100, 1200)),
        )
        for _ in range(3)
    )
    return replace(plain, things=spots)


def _motion_blur(random: np.random.Generator, plain: LabScene) -> LabScene:
    fast = replace(plain.swimmers[0], frequency_hz=random.uniform(2.5, 4.0))
    return replace(plain, swimmers=(fast,), exposure_s=random.uniform(0.008, 0.016))


def _bubbles(random: np.random.Generator, plain: LabScene) -> LabScene:
    bubbles = tuple(
        Bubble(
            tuple(
                plain.swimmers[0].dots(random.uniform(0.0, 0.4))[random.integers(3)]
                + random.uniform(-60, 60, 2)
            ),
            random.uniform(4, 20),
            strength=random.uniform(0.4, 1.0),
            velocity=_velocity(random, random.uniform(50, 300)),
        )
        for _ in range(8)
    )
    return replace(plain, things=bubbles)


def _flicker(random: np.random.Generator, plain: LabScene) -> LabScene:
    return replace(
        plain,
        flicker=random.uniform(0.15, 0.4),
        camera=LabCamera(exposure=random.uniform(0.4, 0.9), noise_levels=random.uniform(3, 7)),
    )


def _ruler(random: np.random.Generator, plain: LabScene) -> LabScene:
    """A pale ruler with blue marks at even distances lies in the tank."""
    first, turn = np.array(_somewhere(random)), random.uniform(-np.pi, np.pi)
    along = np.array([np.cos(turn), np.sin(turn)])
    step = random.uniform(90, 150)
    marks = tuple(BlueDot(*(first + (number + 0.5) * step * along), radius=11.0) for number in range(3))
    ruler = LabSwimmer(
        length_px=3.0 * step, start_px=tuple(first), heading_rad=-turn, bend_rad=0.0, taper=1.0, fin_from=1.1,
        half_width_px=26.0, marked=False, body_colour=(215.0, 220.0, 225.0),
    )  # fmt: skip
    return replace(plain, swimmers=(*plain.swimmers, ruler), dots=marks)


def _second_bare(random: np.random.Generator, plain: LabScene) -> LabScene:
    """Another swimmer without dots, and loose dots of which some may lie on it."""
    other = replace(_swimmer(random), marked=False)
    dots = tuple(BlueDot(*_somewhere(random), radius=random.uniform(9, 14)) for _ in range(4))
    return replace(plain, swimmers=(*plain.swimmers, other), dots=dots)


def _specks(random: np.random.Generator, plain: LabScene) -> LabScene:
    dots = tuple(BlueDot(*_somewhere(random), radius=random.uniform(2, 7)) for _ in range(60))
    return replace(plain, dots=dots)


def _one_hidden(random: np.random.Generator, plain: LabScene) -> LabScene:
    """From the first frame on one marker is hidden, and other dots lie about."""
    swimmer = replace(plain.swimmers[0], hidden=((int(random.integers(3)), 0.0, 9.0),))
    dots = tuple(BlueDot(*_somewhere(random), radius=random.uniform(9, 14)) for _ in range(4))
    return replace(plain, swimmers=(swimmer,), dots=dots)


def _drifting_dots(random: np.random.Generator, plain: LabScene) -> LabScene:
    """Blue dots drift past the markers while one of them is hidden for a while."""
    swimmer, number = plain.swimmers[0], int(random.integers(3))
    begin = random.uniform(0.1, 0.2)
    hidden = ((number, begin, begin + random.uniform(0.05, 0.15)),)
    dots = []
    for _ in range(3):
        velocity = np.array(_velocity(random, random.uniform(60, 500)))
        place = swimmer.dots(begin)[number] + random.uniform(-40, 40, 2) - velocity * (begin + 0.05)
        dots.append(BlueDot(*place, radius=random.uniform(9, 14), velocity=tuple(velocity)))
    return replace(plain, swimmers=(replace(swimmer, hidden=hidden),), dots=tuple(dots))


def _case(
    name: str, make: Callable[[np.random.Generator, LabScene], LabScene], expected: bool = False
) -> LabCase:
    return LabCase(name, _drawn(make), expected, least_frames=FRAMES)


UNFORESEEN = (
    _case("light from one side", _light_from_one_side, expected=True),
    _case("a hand", _hand(SKIN)),
    _case("a hand in a blue glove", _hand(BLUE_GLOVE)),
    _case("blue cables", _blue_cable),
    _case("moving glare", _glare),
    _case("motion blur, 8 to 16 ms", _motion_blur, expected=True),
    _case("bubbles over the dots", _bubbles),
    _case("flickering, noisy light", _flicker, expected=True),
    _case("a ruler with blue marks", _ruler),
    _case("sixty blue specks", _specks),
)
# A loose dot on or beside the body, in place of a marker that is out of sight, or another body of the same shade along
# the swimmer.
DECEIVING = (
    _case("a marker out of sight from the start, four loose dots", _one_hidden),
    _case("three dots drift past a marker while it is hidden", _drifting_dots),
    _case("a second swimmer without dots over the first, loose dots", _second_bare),
)
