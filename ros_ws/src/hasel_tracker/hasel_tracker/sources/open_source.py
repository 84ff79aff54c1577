"""Choose a source by what the user typed."""

from pathlib import Path

from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.folder_source import STACK_SUFFIXES, FolderSource, StackSource, stacks
from hasel_tracker.sources.video_source import VideoSource


def open_recorded(
    path: str | Path,
    frame_rate_hz: float | None = None,
    threads: int = 0,
    unsaid_hz: float | None = None,
) -> VideoSource | FolderSource | StackSource:
    """Open a video file, a folder of images or a TIFF stack.

    frame_rate_hz: how fast the pictures were taken [1/s], whatever the source says; unsaid_hz: the same where the
    source does not say it. Raises TrackerError where neither is known.
    """
    path = Path(path)
    if not path.exists():
        raise TrackerError(f"{path} does not exist; give a video file or a folder of images.")
    if frame_rate_hz is not None and not 0.0 < frame_rate_hz < float("inf"):
        raise TrackerError(
            f"A frame rate of {frame_rate_hz:g} was given; expected pictures per second, above 0."
        )
    of_images = path.is_dir() or path.suffix.lower() in STACK_SUFFIXES
    if not of_images:
        return VideoSource(path, threads, frame_rate_hz, unsaid_hz)
    rate = frame_rate_hz or unsaid_hz
    if rate is None:
        what = "a folder of images" if path.is_dir() else "a stack of images"
        raise TrackerError(f"{path} is {what}; say how fast they were taken with --frame-rate.")
    if not path.is_dir():
        return StackSource(path, rate)
    found = stacks(path)
    if found:
        raise TrackerError(
            f"{found[0]} holds many pictures and lies in a folder; name that file, not its folder."
        )
    return FolderSource(path, rate)
