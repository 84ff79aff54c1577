"""`track VIDEO`: from a video or a folder of images to a recording of the bending angle."""

import argparse
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from hasel_tracker.calibration.camera_calibration import CameraCalibration
from hasel_tracker.calibration.settings_file import load_settings
from hasel_tracker.commands.command import point, progress_bar, region, run_command
from hasel_tracker.errors import TrackerError
from hasel_tracker.offline.drive import (
    Alignment,
    Drive,
    align_by_hand,
    align_by_lamp,
    align_by_response,
    align_by_stamp,
    read_drive,
)
from hasel_tracker.offline.fixes import read_fixes
from hasel_tracker.offline.movement import cut_to_periods
from hasel_tracker.offline.run_output import write_run
from hasel_tracker.offline.tracked_run import TrackedRun, track_frames
from hasel_tracker.sources.folder_source import FolderSource
from hasel_tracker.sources.frame import Frame
from hasel_tracker.sources.open_source import open_recorded
from hasel_tracker.sources.video_source import VideoSource
from hasel_tracker.tracking.bending_tracker import DEFAULT_METHOD, BendingTracker, TrackedFrame
from hasel_tracker.tracking.silhouette import BODY_KINDS
from hasel_tracker.tracking.tracker_settings import METHODS, TrackerSettings
from hasel_tracker.video.annotation import annotate
from hasel_tracker.video.video_writer import H264Writer


def parser() -> argparse.ArgumentParser:
    """The command's options."""
    options = argparse.ArgumentParser(prog="track", description="Track the markers of a video.")
    options.add_argument("video", type=Path, help="video file, or folder of images")
    options.add_argument("--output", "-o", type=Path, required=True, help="recording to write: .csv or .mcap")
    options.add_argument(
        "--annotate", type=Path, metavar="VIDEO", help="write a video of what was found (H.264)"
    )
    options.add_argument("--method", choices=METHODS, default=DEFAULT_METHOD, help="default: %(default)s")
    options.add_argument(
        "--markers", type=int, metavar="N", help="how many, 2 to 15 (default: 3, or as --settings says)"
    )
    options.add_argument(
        "--points",
        metavar="N|S,S,…",
        help="of midline: how many points, or at which shares of the length from the head",
    )
    options.add_argument(
        "--body", choices=tuple(BODY_KINDS), help="of midline: how the body stands out (default: auto)"
    )
    options.add_argument(
        "--head", metavar="SIDE", help="where the head is in the first frame: left, right, top, bottom or X,Y"
    )
    options.add_argument(
        "--at",
        type=point,
        nargs="+",
        metavar="X,Y",
        help="the markers in the first frame, head first, by hand",
    )
    options.add_argument(
        "--fix", type=Path, metavar="FILE", help="frames and the markers' positions in them, by hand (YAML)"
    )
    options.add_argument(
        "--roi", type=region, metavar="X,Y,W,H", help="look only within this part of the picture"
    )
    options.add_argument(
        "--box", type=_box, nargs="+", metavar="X,Y,W,H", help="boxes for csrt, from head to tail"
    )
    options.add_argument("--settings", type=Path, help="colour, size and region, from `calibrate colour`")
    options.add_argument("--calibration", type=Path, help="lens and perspective, from `calibrate board`")
    options.add_argument(
        "--mirrored", action="store_true", help="the camera looks from below or over a mirror"
    )
    options.add_argument("--frame-rate", type=float, metavar="HZ", help="of a folder of images")
    options.add_argument("--drive", type=Path, help="the drive's recording (.mcap or .csv), to merge")
    options.add_argument("--merge", choices=("auto", "stamp", "lag"), default="auto",
                         help="by stamp, by the lag found, or stamp if both have it (default)")  # fmt: skip
    options.add_argument(
        "--lag", type=float, metavar="SECONDS", help="merge by this lag, added to the drive's time"
    )
    options.add_argument(
        "--led",
        type=region,
        metavar="X,Y,W,H",
        help="merge by a lamp here that lights when the drive starts",
    )
    options.add_argument(
        "--cut", type=float, metavar="HZ", help="keep two periods of this frequency from the first movement"
    )
    options.add_argument(
        "--periods", type=float, default=2.0, help="periods to keep with --cut (default: %(default)g)"
    )
    options.add_argument("--model", help="model named in the recording's header")
    return options


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    options = parser().parse_args(arguments)
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
    source: VideoSource | FolderSource,
    tracker: BendingTracker,
    annotated: Path | None,
    placed: dict[int, np.ndarray],
    led: tuple[int, int, int, int] | None,
    lamp: list[float],
) -> TrackedRun:
    video = None if annotated is None else H264Writer(annotated, source.frame_rate_hz)
    with progress_bar() as progress:
        task = progress.add_task("tracking", total=source.frame_count or None)

        def seen(frame: Frame, tracked: TrackedFrame) -> None:
            if video is not None:
                video.write(annotate(frame.image, tracked), frame.time_s)
            if led is not None:
                x, y, width, height = led
                lamp.append(float(frame.image[y : y + height, x : x + width].mean()))
            progress.advance(task)

        try:
            return track_frames(source, tracker, seen, source.start_stamp_ns, placed)
        finally:
            if video is not None:
                video.close()


def _align(run: TrackedRun, drive: Drive, options: argparse.Namespace, lamp: np.ndarray) -> Alignment:
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


def _box(text: str) -> tuple[int, int, int, int]:
    values = [int(part) for part in text.split(",")]
    if len(values) != 4 or min(values[2:]) < 4:
        raise argparse.ArgumentTypeError(f"'{text}' is not a box X,Y,WIDTH,HEIGHT in pixels")
    left, top, width, height = values
    return left, top, width, height


if __name__ == "__main__":
    sys.exit(main())
