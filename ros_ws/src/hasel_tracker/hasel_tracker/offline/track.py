# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`track VIDEO`: from a video or a folder of images to a recording of the bending angle."""

import argparse
import sys
from dataclasses import replace
from itertools import count
from pathlib import Path

import numpy as np
from hasel_common.progress import counted

from hasel_tracker.calibration.camera_calibration import CameraCalibration
from hasel_tracker.errors import TrackerError, run_command
from hasel_tracker.offline.drive import (
    Drive,
    DriveAlignment,
    align_by_hand,
    align_by_lamp,
    align_by_response,
    align_by_stamp,
    read_drive,
)
from hasel_tracker.offline.run_output import write_run
from hasel_tracker.offline.tracked_run import TrackedRun, cut_to_periods, read_fixes, track_frames
from hasel_tracker.sources.frame import Frame
from hasel_tracker.sources.recorded_source import FolderSource, StackSource, open_recorded
from hasel_tracker.sources.video_source import VideoSource
from hasel_tracker.tracking.bending_tracker import BendingTracker, TrackedFrame
from hasel_tracker.tracking.tracker_settings import TrackerSettings, load_settings
from hasel_tracker.video.annotation import annotate
from hasel_tracker.video.video_writer import H264Writer


def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code."""
    return run_command(lambda: _track(options))


def _track(options: argparse.Namespace) -> None:
    if options.output.suffix.lower() not in (".csv", ".mcap"):
        raise TrackerError(
            f"The output {options.output} is neither .csv nor .mcap; end its name in one of them."
        )
    drive = None if options.drive is None else read_drive(options.drive)
    source = open_recorded(options.video, options.frame_rate)
    placed = {} if options.fix is None else read_fixes(options.fix)
    placed |= {} if options.at is None else {0: np.array(options.at)}
    tracker = BendingTracker(
        _settings(options, placed),
        options.method,
        CameraCalibration.load(options.calibration) if options.calibration else None,
        options.mirrored,
        options.box,
        options.roi,
    )
    lamp: list[float] = []
    run = _follow(source, tracker, options.annotate, placed, options.led, lamp)
    print(f"{options.video}: {run}")
    for note in source.notes:
        print(f"{options.video}: {note}.")
    if source.damaged_frames:
        print(f"warning: {source.damaged_frames} frames are damaged and were left out.", file=sys.stderr)
    print(f"Markers: {tracker.note}.")
    if not run.valid.any():
        raise TrackerError(
            f"No frame of {options.video} gives an angle ({tracker.note}); {_advice(options.method)}."
        )
    alignment = None if drive is None else _align(run, drive, options, np.array(lamp))
    if alignment is not None:
        print(alignment)
    if options.cut is not None:
        run = cut_to_periods(run, options.cut, options.periods)
        print(f"Cut to {len(run.time_s)} frames from {run.time_s[0]:.4f} s.")
    left_out = write_run(options.output, run, drive, alignment, _metadata(options))
    if left_out:
        print(f"warning: {left_out}", file=sys.stderr)
    print(f"Wrote {options.output}.")


def _follow(
    source: VideoSource | FolderSource | StackSource,
    tracker: BendingTracker,
    annotated: Path | None,
    placed: dict[int, np.ndarray],
    led: tuple[int, int, int, int] | None,
    lamp: list[float],
) -> TrackedRun:
    video = None if annotated is None else H264Writer(annotated, source.frame_rate_hz)
    with counted("tracking", "frames", source.frame_count or None) as done:
        numbers = count(1)

        def seen(frame: Frame, tracked: TrackedFrame) -> None:
            if video is not None:
                video.write(annotate(frame.image, tracked), frame.time_s)
            if led is not None:
                x, y, width, height = led
                lamp.append(float(frame.image[y : y + height, x : x + width].mean()))
            done(next(numbers))

        try:
            return track_frames(source, tracker, seen, source.start_stamp_ns, placed)
        finally:
            if video is not None:
                video.close()


def _align(run: TrackedRun, drive: Drive, options: argparse.Namespace, lamp: np.ndarray) -> DriveAlignment:
    if options.lag is not None:
        return align_by_hand(options.lag, run, drive)
    if options.led is not None:
        return align_by_lamp(run, drive, lamp)
    merge = options.merge
    stamped = run.start_stamp_ns is not None and drive.start_stamp_ns is not None
    if merge == "stamp" or (merge == "auto" and stamped):
        return align_by_stamp(run, drive)
    return align_by_response(run, drive)


def _metadata(options: argparse.Namespace) -> dict[str, str]:
    metadata = {"source": options.video.name, "tracking_method": options.method}
    return metadata | ({"model": options.model} if options.model else {})


def _advice(method: str) -> str:
    if method == "midline":
        return "say where to look with --roi, or see what stands out with `calibrate body`"
    return "point at the markers with --at, or learn their colour with `calibrate colour`"


def _settings(options: argparse.Namespace, placed: dict[int, np.ndarray]) -> TrackerSettings:
    """Settings from the file, with what the command line says beside it."""
    settings = load_settings(options.settings) if options.settings else TrackerSettings()
    if (options.points is not None or options.body is not None) and options.method != "midline":
        raise TrackerError("--points and --body are of --method midline; give that too, or leave them out.")
    if options.body is not None:
        settings = replace(settings, body=options.body)
    if options.points is not None:
        shares = "" if options.points.isdigit() else options.points
        count = len(shares.split(",")) if shares else int(options.points)
        settings = replace(settings, points=shares, marker_count=count)
    if options.head is not None:
        settings = replace(settings, head=options.head)
    counts = {len(points) for points in placed.values()} | ({options.markers} - {None})
    if len(counts) > 1:
        raise TrackerError(
            f"The numbers of markers given differ ({sorted(counts)}); give all markers everywhere."
        )
    return replace(settings, marker_count=counts.pop()) if counts else settings
