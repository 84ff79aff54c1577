# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The scenes by name: where a tracker must not publish a wrong angle, real laboratories, swimmers without dots."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from hasel_tracker.tracking.tracker_settings import TrackerSettings

from hasel_tracker_lab.scenes.lab_scene import BlueDot, LabCamera, LabScene
from hasel_tracker_lab.scenes.lab_swimmer import LabSwimmer
from hasel_tracker_lab.scenes.lab_things import Cable

RIGHT_WAY, TURNED = LabSwimmer(), LabSwimmer(start_px=(960.0, 360.0), heading_rad=np.pi)
TAIL = 2
BARE = replace(RIGHT_WAY, marked=False, body_colour=(58.0, 56.0, 54.0))
ALIKE = replace(BARE, taper=1.0, fin_from=1.1, half_width_px=20.0)
SHARES = TrackerSettings(points="0.05,0.5,0.97")


@dataclass(frozen=True)
class LabCase:
    """A scene by name; `expected`: an angle is due in (nearly) every frame in which all dots are seen.

    settings: what the user tells the tracker. least_frames: until what the case is about has happened.
    h264_rate_factor: the video goes through H.264. method: how the dots
    are located; None leaves it to the caller.
    """

    name: str
    scene: Callable[[int], LabScene]
    expected: bool = True
    settings: TrackerSettings = TrackerSettings()  # noqa: RUF009
    h264_rate_factor: int | None = None
    method: str | None = None
    least_frames: int = 8


def one_seed(scene: LabScene) -> Callable[[int], LabScene]:
    """The same scene whatever the seed, but for its noise."""
    return lambda seed: replace(scene, seed=seed + 1)


def scattered_dots(seed: int, count: int, swimmers: tuple[LabSwimmer, ...]) -> LabScene:
    """Dots anywhere in the picture, of sizes like a marker's or not."""
    random = np.random.default_rng(seed)
    dots = tuple(
        BlueDot(*random.uniform([60, 60], [1220, 660]), radius=float(random.uniform(7, 17)))
        for _ in range(count)
    )
    turned = tuple(_somewhere(random, each) for each in swimmers)
    return LabScene(turned, dots, seed=seed, exposure_s=0.0)


def _somewhere(random: np.random.Generator, swimmer: LabSwimmer) -> LabSwimmer:
    heading = random.uniform(-np.pi, np.pi)
    middle = np.array([640.0, 360.0]) + random.uniform(-40, 40, 2)
    start = middle - 0.5 * 520.0 * np.array([np.cos(heading), -np.sin(heading)])
    return replace(swimmer, start_px=tuple(start), heading_rad=heading, length_px=520.0)


def _two(seed: int) -> LabScene:
    random = np.random.default_rng(seed)
    gap = random.uniform(90, 250)
    upper = replace(RIGHT_WAY, start_px=(300 + random.uniform(-80, 80), 360 - gap / 2), bend_rad=0.5)
    lower = replace(RIGHT_WAY, start_px=(300 + random.uniform(-80, 80), 360 + gap / 2), bend_rad=-0.4)
    return LabScene((upper, lower), seed=seed, exposure_s=0.0)


def _dot_for_hidden_tail(seed: int) -> LabScene:
    """The tail is covered while a like dot lies at its distance from the middle, to a side."""
    random = np.random.default_rng(seed)
    swimmer = replace(RIGHT_WAY, hidden=((TAIL, 0.1, 0.35),), bend_rad=0.6)
    _, middle, tail = swimmer.dots(0.1)
    angle = random.choice([-1, 1]) * random.uniform(0.5, 0.9)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    place = middle + turn @ (tail - middle)
    return LabScene((swimmer,), (BlueDot(*place, radius=11.0),), seed=seed, exposure_s=0.0)


def _reflected(strength: float) -> Callable[[int], LabScene]:
    def scene(seed: int) -> LabScene:
        swimmer = replace(RIGHT_WAY, start_px=(320.0, 340.0), bend_rad=0.5)
        return LabScene((swimmer,), reflection=(340.0 + 6.0 + 2.0 * seed, strength), seed=seed)

    return scene


def _gliding_in(seed: int) -> LabScene:
    random = np.random.default_rng(seed)
    drift = (float(random.uniform(400, 600)), float(random.uniform(-60, 60)))
    swimmer = replace(RIGHT_WAY, start_px=(-120.0, 360.0), drift_px_s=drift, rest_s=0.05)
    return LabScene((swimmer,), exposure_s=0.0, frame_rate_hz=60.0, seed=seed)


def _covered_at_start(seed: int) -> LabScene:
    swimmer = replace(RIGHT_WAY, hidden=(((TAIL + seed) % 3, 0.0, 0.05),))
    return LabScene((swimmer,), exposure_s=0.0, seed=seed)


def _untapered(seed: int) -> LabScene:
    random = np.random.default_rng(seed)
    return LabScene((UNTAPERED if seed == 0 else _somewhere(random, UNTAPERED),), seed=seed)


def _all_away(seed: int) -> LabScene:
    random = np.random.default_rng(seed)
    swimmer = replace(RIGHT_WAY, hidden=AWAY, heading_rad=random.uniform(-0.5, 0.5), bend_rad=0.5)
    return LabScene((swimmer,), exposure_s=0.0, frame_rate_hz=40.0, seed=seed)


UNTAPERED = replace(TURNED, taper=1.0, fin_from=1.1, half_width_px=20.0)
AWAY = tuple((dot, 0.2, 1.5) for dot in range(3))

ADVERSARIAL = (
    LabCase("no swimmer, three blue dots", lambda seed: scattered_dots(seed, 3, ()), expected=False),
    LabCase("no swimmer, eight blue dots", lambda seed: scattered_dots(seed, 8, ()), expected=False),
    LabCase("swimmer and three blue dots", lambda seed: scattered_dots(seed, 3, (RIGHT_WAY,))),
    LabCase(
        "swimmer and eight blue dots", lambda seed: scattered_dots(seed, 8, (RIGHT_WAY,)), expected=False
    ),
    LabCase("two swimmers", _two, expected=False),
    LabCase(
        "three blue dots on a textured ground",
        lambda seed: replace(scattered_dots(seed, 3, ()), texture=25.0),
        expected=False,
    ),
    LabCase("tail hidden, a blue dot at its distance", _dot_for_hidden_tail, least_frames=48),
    LabCase("gliding into the picture", _gliding_in, least_frames=40),
    LabCase("a marker covered at the start", _covered_at_start, least_frames=14),
    LabCase("body without taper", _untapered, expected=False),
    LabCase(
        "body without taper, head given",
        one_seed(LabScene((UNTAPERED,))),
        settings=TrackerSettings(head="right"),
    ),
    LabCase("all hidden for over a second", _all_away, least_frames=68),
    LabCase("reflection over the dots, 40 %", _reflected(0.4), expected=False),
    LabCase("reflection over the dots, 60 %", _reflected(0.6), expected=False),
    LabCase("reflection over the dots, 80 %", _reflected(0.8), expected=False),
    LabCase(
        "a blue dot drifts past the tail",
        lambda seed: LabScene(
            (replace(RIGHT_WAY, bend_rad=0.4),),
            (BlueDot(890.0, 180.0 + 12 * seed, velocity=(60.0, 560.0)),),
            seed=seed,
            exposure_s=0.0,
        ),
        expected=False,
        least_frames=24,
    ),
    LabCase(
        "tether across a dot's rim",
        lambda seed: LabScene(
            (replace(RIGHT_WAY, bend_rad=0.3),),
            things=(Cable((650.0, 0.0), (640.0 + 4.0 * seed, 720.0)),),
            seed=seed,
            exposure_s=0.0,
        ),
        expected=False,
    ),
)

RAW = LabScene((replace(RIGHT_WAY, electrodes=True),))
REAL = (
    LabCase("plain, no noise", one_seed(LabScene(camera=LabCamera(noise_levels=0.0, bayer=False)))),
    LabCase("Bayer, 4:2:0, noise", one_seed(LabScene())),
    LabCase("electrodes beside the dots", one_seed(RAW)),
    LabCase("electrodes, MJPEG 75", one_seed(replace(RAW, camera=LabCamera(jpeg_quality=75)))),
    LabCase("electrodes, H.264 crf 18", one_seed(RAW), h264_rate_factor=18),
    LabCase("electrodes, H.264 crf 28", one_seed(RAW), h264_rate_factor=28),
    LabCase("textured ground", one_seed(replace(RAW, texture=22.0))),
    LabCase("gloss inside the dots", one_seed(LabScene((replace(RIGHT_WAY, gloss=0.8),)))),
    LabCase("exposure × 0.2", one_seed(replace(RAW, camera=LabCamera(exposure=0.2)))),
    LabCase("exposure × 1.3", one_seed(replace(RAW, camera=LabCamera(exposure=1.3)))),
    LabCase("defocus σ 3 px", one_seed(replace(RAW, camera=LabCamera(blur_px=3.0)))),
    LabCase("motion blur 8 ms", one_seed(replace(RAW, exposure_s=0.008))),
    LabCase("dark tank", one_seed(replace(RAW, water=(38.0, 36.0, 32.0)))),
    LabCase("dark body", one_seed(LabScene((replace(RIGHT_WAY, body_colour=(58.0, 56.0, 54.0)),)))),
    LabCase(
        "dots of 10 px", one_seed(LabScene((replace(RIGHT_WAY, dot_radius_px=5.0, half_width_px=16.0),)))
    ),
    LabCase(
        "dots of 60 px", one_seed(LabScene((replace(RIGHT_WAY, dot_radius_px=30.0, half_width_px=50.0),)))
    ),
    LabCase(
        "640 × 480, dots of 12 px",
        one_seed(
            LabScene(
                (
                    LabSwimmer(
                        480.0, (80.0, 240.0), dot_radius_px=6.0, half_width_px=18.0, fin_half_width_px=2.0
                    ),
                ),
                size_px=(640, 480),
            )
        ),
    ),
    LabCase(
        "30 frames/s, 4 Hz",
        one_seed(LabScene((replace(RIGHT_WAY, frequency_hz=4.0, bend_rad=0.6),), frame_rate_hz=30.0)),
    ),
    *(
        LabCase(
            f"AprilTags of {side_px} px",
            one_seed(
                LabScene((replace(RIGHT_WAY, tags=True, dot_radius_px=side_px / 2.4, half_width_px=45.0),))
            ),
            method="apriltag",
        )
        for side_px in (24, 60)
    ),
)


def _bare(name: str, scene: LabScene, **more: Any) -> LabCase:
    return LabCase(f"midline: {name}", one_seed(scene), **({"settings": SHARES} | more), method="midline")


MIDLINE = (
    _bare("dark body and its shadow", LabScene((BARE,))),
    _bare("dark body, MJPEG 75", LabScene((BARE,), camera=LabCamera(jpeg_quality=75))),
    _bare("dark body, H.264 crf 28", LabScene((BARE,)), h264_rate_factor=28),
    _bare("dark body, defocus σ 2 px", LabScene((BARE,), camera=LabCamera(blur_px=2.0))),
    _bare("stout body", LabScene((replace(BARE, half_width_px=52.0),))),
    _bare("dark tank", LabScene((replace(RIGHT_WAY, marked=False),), water=(38.0, 36.0, 32.0))),
    _bare("dark tank, electrodes",
          LabScene((replace(RIGHT_WAY, marked=False, electrodes=True),), water=(38.0, 36.0, 32.0))),
    _bare("exposure × 0.2", LabScene((BARE,), camera=LabCamera(exposure=0.2))),
    _bare("grey body, its shadow nearly as dark",
          LabScene((replace(BARE, body_colour=(95.0, 95.0, 95.0)),), shadow=0.4), expected=False),
    _bare("light body with a shadow", LabScene((replace(RIGHT_WAY, marked=False),)), expected=False),
    _bare("light body with a shadow, --body light", LabScene((replace(RIGHT_WAY, marked=False),)),
          settings=replace(SHARES, body="light")),
    _bare("textured ground", LabScene((BARE,), texture=22.0), expected=False),
    _bare("halves alike", LabScene((ALIKE,)), expected=False),
    _bare("halves alike, head on the right, --head",
          LabScene((replace(ALIKE, start_px=(960.0, 360.0), heading_rad=np.pi),)),
          settings=replace(SHARES, head="right")),
    _bare("two swimmers", LabScene((replace(BARE, start_px=(300.0, 240.0)),
                                    replace(BARE, start_px=(330.0, 500.0)))), expected=False),
    _bare("gliding into the picture",
          LabScene((replace(BARE, start_px=(-120.0, 360.0), drift_px_s=(500.0, 0.0)),),
                   exposure_s=0.0, frame_rate_hz=30.0), least_frames=20),
    _bare("tail covered for a while",
          LabScene((replace(BARE, hidden=((TAIL, 0.1, 0.2),), cover_colour=(170.0, 175.0, 168.0)),),
                   frame_rate_hz=60.0, shadow=0.0),
          least_frames=18),
    _bare("tether across the body", LabScene((BARE,), things=(Cable((650.0, 0.0), (640.0, 720.0)),)), expected=False),
    _bare("no swimmer, eight dots", scattered_dots(3, 8, ()), expected=False),
)  # fmt: skip
