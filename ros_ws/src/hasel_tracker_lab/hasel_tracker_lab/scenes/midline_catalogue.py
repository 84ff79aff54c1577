"""Scenes of swimmers without dots, for the method midline."""

from dataclasses import replace
from typing import Any

import numpy as np
from hasel_tracker.tracking.tracker_settings import TrackerSettings

from hasel_tracker_lab.scenes.catalogue import RIGHT_WAY, TAIL, LabCase, one_seed, scattered_dots
from hasel_tracker_lab.scenes.lab_camera import LabCamera
from hasel_tracker_lab.scenes.lab_scene import LabScene
from hasel_tracker_lab.scenes.lab_things import Cable

BARE = replace(RIGHT_WAY, marked=False, body_colour=(58.0, 56.0, 54.0))
ALIKE = replace(BARE, taper=1.0, fin_from=1.1, half_width_px=20.0)
SHARES = TrackerSettings(points="0.05,0.5,0.97")


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
