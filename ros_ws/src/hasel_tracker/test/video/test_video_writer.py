# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import subprocess
import sys
import textwrap

import cv2
import numpy as np
import pytest
from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.video_source import VideoSource
from hasel_tracker.video.video_writer import H264Writer, JpegWriter

STAMP_NS = 1_700_000_000_123_456_789


@pytest.mark.parametrize("name", ["video.mp4", "video.mkv", "video.avi", "video.mov"])
def test_jpeg_pictures_go_in_unchanged(frames, tmp_path, name):
    """A JPEG picture written to a video comes out exactly as OpenCV decodes it, with its time."""
    writer = JpegWriter(tmp_path / name, 120.0)
    codes = [cv2.imencode(".jpg", frame.image)[1] for frame in frames[:5]]
    for code, frame in zip(codes, frames, strict=False):
        writer.write_jpeg(code.tobytes(), (640, 360), frame.time_s)
    writer.close()
    read = list(VideoSource(tmp_path / name))
    assert [frame.time_s for frame in read] == pytest.approx([k / 120 for k in range(5)], abs=6e-4)
    expected = cv2.imdecode(codes[3], cv2.IMREAD_COLOR)
    assert np.abs(read[3].image.astype(float) - expected).mean() < 2.5


@pytest.mark.parametrize("name", ["video.mp4", "video.mkv"])
def test_start_stamp_is_kept(frames, tmp_path, name):
    """The time of the first frame since the epoch is in the file, to the nanosecond."""
    writer = JpegWriter(tmp_path / name, 120.0, start_stamp_ns=STAMP_NS)
    writer.write(frames[0].image)
    writer.close()
    assert VideoSource(tmp_path / name).start_stamp_ns == STAMP_NS
    assert next(iter(VideoSource(tmp_path / name))).stamp_ns == STAMP_NS


def test_irregular_times_are_kept(frames, tmp_path):
    """Dropped frames leave a gap in the video instead of shifting what follows."""
    writer = JpegWriter(tmp_path / "video.mp4", 120.0)
    times = [0.0, 1 / 120, 5 / 120, 6 / 120]
    for time_s in times:
        writer.write(frames[0].image, time_s)
    writer.close()
    assert [frame.time_s for frame in VideoSource(tmp_path / "video.mp4")] == pytest.approx(times, abs=1e-4)


def test_h264_is_small_and_like_the_picture(frames, tmp_path):
    """H.264 is several times smaller than MJPEG, and close to what was written."""
    sizes = []
    for name, writer in (
        ("a.mp4", H264Writer(tmp_path / "a.mp4", 120.0)),
        ("b.mp4", JpegWriter(tmp_path / "b.mp4", 120.0)),
    ):
        for frame in frames[:12]:
            writer.write(frame.image)
        writer.close()
        sizes.append((tmp_path / name).stat().st_size)
    read = list(VideoSource(tmp_path / "a.mp4"))
    assert len(read) == 12
    assert sizes[0] < 0.5 * sizes[1]
    assert np.abs(read[6].image.astype(float) - frames[6].image).mean() < 4.0


def test_killed_writer_leaves_a_readable_file(tmp_path):
    """After a kill in the middle of recording, at most the last second is missing."""
    path = tmp_path / "video.mp4"
    program = f"""
        import os, numpy as np
        from pathlib import Path
        from hasel_tracker.video.video_writer import JpegWriter
        writer = JpegWriter(Path({str(path)!r}), 120.0)
        for index in range(360):
            writer.write(np.full((64, 64, 3), index % 250, np.uint8))
        os.kill(os.getpid(), 9)
    """
    subprocess.run([sys.executable, "-c", textwrap.dedent(program)], check=False)
    assert len(list(VideoSource(path))) >= 240


def test_unwritable_place_is_explained(tmp_path):
    """A folder that does not exist, or an unknown kind of file, is named."""
    for path in (tmp_path / "nowhere" / "video.mp4", tmp_path / "video.xyz"):
        with pytest.raises(TrackerError, match="cannot be written"):
            JpegWriter(path, 120.0)
