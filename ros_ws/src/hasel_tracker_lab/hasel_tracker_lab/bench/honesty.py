# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""How often a tracker says `valid` to a wrong angle, and how far off the right ones are."""

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from hasel_tracker.offline.tracked_run import track_frames
from hasel_tracker.sources.frame import Frame
from hasel_tracker.sources.video_source import VideoSource
from hasel_tracker.tracking.bending_tracker import BendingTracker
from hasel_tracker.video.video_writer import H264Writer

from hasel_tracker_lab.bench.accuracy import image_of
from hasel_tracker_lab.scenes.lab_scene import LabFrame
from hasel_tracker_lab.scenes.scene_catalogue import LabCase

WRONG_SINE = 0.01


@dataclass(frozen=True)
class Honesty:
    """Of a case: frames, those with all dots in view, and of these the valid ones; valid frames that are wrong.

    An angle is wrong if it is off by more than 0.01 in sin θ, or given where the dots of no swimmer were in view.
    worst_px, rms_px: distance of the dots in valid, right frames; sin_theta_rms: error of sin θ there.
    """

    case: str
    frames: int
    due: int
    valid: int
    wrong: int
    rms_px: float
    sin_theta_rms: float
    sin_theta_std: float

    @property
    def lost_share(self) -> float:
        """Share of the frames with every dot in view that have no angle."""
        return 1.0 - self.valid / self.due if self.due else float("nan")

    def __str__(self) -> str:
        return (
            f"{self.case}: {self.wrong} of {self.frames} frames wrong while valid, {100 * self.lost_share:.0f} % lost, "
            f"{self.rms_px:.3f} px and sin θ {self.sin_theta_rms:.1e} rms (said: {self.sin_theta_std:.1e})."
        )


def measure_honesty(
    case: LabCase, frames: int, seeds: int = 1, method: str | None = None, recorded: bool = True
) -> Honesty:
    """Track a case `seeds` times, `frames` each. recorded: frames held in doubt count once the doubt is resolved."""
    due = valid = wrong = total = 0
    errors, sines, said = [], [], []
    for seed in range(seeds):
        pictures = list(_pictures(case, seed, frames))
        tracker = BendingTracker(case.settings, case.method or method or "contour")
        run = track_frames((Frame(i, p.time_s, image=p.image) for i, p in enumerate(pictures)), tracker)
        for index, picture in enumerate(pictures):
            seen = bool(picture.seen.all())
            off = abs(run.sin_theta[index] - picture.sin_theta) if run.valid[index] else 0.0
            is_wrong = bool(run.valid[index] and not off <= WRONG_SINE)
            total, due, wrong = total + 1, due + seen, wrong + is_wrong
            if run.valid[index] and not is_wrong:
                valid += seen
                errors.append(run.markers_px[index] - picture.dots_px)
                sines.append(off)
                if run.sin_theta_std is not None:
                    said.append(run.sin_theta_std[index])
    if not sines:
        return Honesty(case.name, total, due, 0, wrong, *[float("nan")] * 3)
    squared = (np.array(errors) ** 2).sum(axis=2)
    return Honesty(
        case.name, total, due, valid, wrong,
        float(np.sqrt(squared.mean())), float(np.sqrt(np.mean(np.square(sines)))), float(np.median(said)),
    )  # fmt: skip


def _pictures(case: LabCase, seed: int, count: int) -> Iterator[LabFrame]:
    scene = case.scene(seed)
    if case.h264_rate_factor is None:
        yield from scene.frames(count)
        return
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "lab.mp4"
        writer = H264Writer(path, scene.frame_rate_hz, case.h264_rate_factor)
        truth = []
        for frame in scene.frames(count):
            writer.write(frame.image, frame.time_s)
            truth.append(frame)
        writer.close()
        for decoded, known in zip(VideoSource(path, threads=1), truth, strict=True):
            yield LabFrame(
                image_of(decoded), *(getattr(known, n) for n in list(known.__dataclass_fields__)[1:])
            )
