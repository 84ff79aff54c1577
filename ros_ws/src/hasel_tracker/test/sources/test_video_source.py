# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
from pathlib import Path

import cv2
import numpy as np
import pytest
from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.recorded_source import open_recorded
from hasel_tracker.sources.video_source import VideoSource
from hasel_tracker.video.video_writer import JpegWriter


def test_every_frame_with_its_time(video, frames):
    """All frames come in order, each with the time it was written with, and look like what was written."""
    source = VideoSource(video)
    read = list(source)
    assert (source.frame_rate_hz, source.frame_count, source.size_px) == (120.0, 84, (640, 360))
    assert [frame.time_s for frame in read] == pytest.approx([frame.time_s for frame in frames], abs=1e-4)
    assert np.abs(read[40].image.astype(float) - frames[40].image).mean() < 4.0


def test_opencv_reads_the_same_pictures(video):
    """OpenCV's own reader sees the same pictures: nothing is shifted or lost."""
    capture = cv2.VideoCapture(str(video))
    for frame in VideoSource(video, threads=1):
        assert np.abs(capture.read()[1].astype(float) - frame.image).mean() < 3.0


def test_folder_in_natural_order(tmp_path):
    """frame_10 comes after frame_9, and the times are those of the numbers and the rate given."""
    for number in (10, 9, 8):
        cv2.imwrite(str(tmp_path / f"frame_{number}.png"), np.full((8, 8, 3), number, np.uint8))
    read = list(open_recorded(tmp_path, 50.0))
    assert [int(frame.image[0, 0, 0]) for frame in read] == [8, 9, 10]
    assert [frame.time_s for frame in read] == pytest.approx([0.0, 0.02, 0.04])


def test_what_cannot_be_opened_is_explained(tmp_path):
    """A missing file, no video, an empty folder, a folder without rate: each gets its own sentence."""
    text = tmp_path / "notes.mp4"
    text.write_text("not a video")
    (tmp_path / "empty").mkdir()
    for path, rate, message in (
        (tmp_path / "nothing.mp4", None, "does not exist"),
        (text, None, "cannot be opened as a video"),
        (tmp_path / "empty", 30.0, "holds no images"),
        (tmp_path / "empty", None, "with --frame-rate"),
    ):
        with pytest.raises(TrackerError, match=message):
            open_recorded(path, rate)
    (tmp_path / "broken.tif").write_text("no picture")
    with pytest.raises(TrackerError, match="not a readable image"):
        open_recorded(tmp_path / "broken.tif", 30.0)


def test_video_cut_off_in_the_middle_gives_what_is_there(video, tmp_path):
    """The first half of a video file, as after a power cut, is read up to its end."""
    half = tmp_path / "half.mp4"
    half.write_bytes(Path(video).read_bytes()[: Path(video).stat().st_size // 2])
    assert 20 < len(list(VideoSource(half))) < 84


def test_times_that_mkv_rounds_to_milliseconds_are_mended(frames, tmp_path):
    """MKV keeps times to 1 ms; frames at 120 per second come back with their own times and rate."""
    path = tmp_path / "swim.mkv"
    writer = JpegWriter(path, 120.0)
    for frame in frames[:30]:
        writer.write(frame.image, frame.time_s)
    writer.close()
    times = [frame.time_s for frame in VideoSource(path)]
    assert times == pytest.approx([frame.time_s for frame in frames[:30]], abs=1e-9)
