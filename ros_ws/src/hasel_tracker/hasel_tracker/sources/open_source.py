"""Choose a source by what the user typed."""

from pathlib import Path

from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.folder_source import FolderSource
from hasel_tracker.sources.video_source import VideoSource


def open_recorded(
    path: str | Path, frame_rate_hz: float | None = None, threads: int = 0
) -> VideoSource | FolderSource:
    """Open a video file or a folder of images; a folder needs its frame rate [1/s]."""
    path = Path(path)
    if not path.exists():
        raise TrackerError(f"{path} does not exist; give a video file or a folder of images.")
    if not path.is_dir():
        return VideoSource(path, threads)
    if frame_rate_hz is None or not frame_rate_hz > 0.0:
        raise TrackerError(f"{path} is a folder of images; say how fast they were taken with --frame-rate.")
    return FolderSource(path, frame_rate_hz)
