# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Videos as cameras and phones make them: times, shape, fields and orientation are as the file says."""

from fractions import Fraction

import av
import cv2
import numpy as np
import pytest
from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.recorded_source import open_recorded
from hasel_tracker.sources.video_source import VideoSource

HEIGHT, WIDTH = 96, 128


def picture(shift: int = 0) -> np.ndarray:
    """Red at the top left, green at the top right, blue at the bottom left, a white column at 40 + shift."""
    image = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
    image[:48, :64], image[:48, 64:], image[48:, :64] = (0, 0, 220), (0, 220, 0), (220, 0, 0)
    image[:, 40 + shift : 44 + shift] = 255
    return image


def written(
    path, pictures, rate=30, aspect=None, matrix=None, options=None, metadata=None, container_format=None
):
    """An H.264 file of these BGR pictures."""
    with av.open(str(path), "w", format=container_format, options={"movflags": "use_metadata_tags"}) as file:
        file.metadata.update(metadata or {})
        stream = file.add_stream("libx264", rate=rate, options={"crf": "5", **(options or {})})
        stream.width, stream.height, stream.pix_fmt = WIDTH, HEIGHT, "yuv420p"
        if aspect:
            stream.codec_context.sample_aspect_ratio = aspect
        if matrix:
            stream.set_display_matrix(matrix)
        for image in pictures:
            file.mux(stream.encode(av.VideoFrame.from_ndarray(image, format="bgr24")))
        file.mux(stream.encode())
    return path


def colours(image: np.ndarray) -> str:
    """The colours of the four quarters, row by row."""
    height, width = image.shape[:2]
    sites = [image[height * y // 8, width * x // 8] for y in (1, 7) for x in (1, 7)]
    return "".join("-" if site.max() < 90 else "bgr"[int(site.argmax())] for site in sites)


ONE = 1 << 16


@pytest.mark.parametrize(
    ("turn", "seen"),
    [
        ((1, 0, 0, 1), "rgb-"),
        ((-1, 0, 0, 1), "gr-b"),
        ((1, 0, 0, -1), "b-rg"),
        ((-1, 0, 0, -1), "-bgr"),
        ((0, 1, -1, 0), "br-g"),
        ((0, -1, 1, 0), "g-rb"),
        ((0, 1, 1, 0), "rbg-"),
    ],
    ids=["upright", "mirrored", "flipped", "180", "90", "270", "transposed"],
)
def test_a_video_is_shown_as_its_metadata_says(tmp_path, turn, seen):
    """Turned or mirrored by metadata, as phones and selfie cameras do: the picture is upright as in a player."""
    a, b, c, d = (ONE * each for each in turn)
    path = written(tmp_path / "phone.mp4", [picture()] * 3, matrix=(a, b, 0, c, d, 0, 0, 0, 1 << 30))
    source = VideoSource(path)
    image = next(iter(source)).image
    assert colours(image) == seen
    assert image.shape[:2] == ((HEIGHT, WIDTH) if turn[0] else (WIDTH, HEIGHT))


@pytest.mark.parametrize(("aspect", "size"), [(Fraction(4, 3), (171, 96)), (Fraction(8, 9), (128, 108))])
def test_pixels_that_are_not_square_are_drawn_out(tmp_path, aspect, size):
    """Anamorphic and DV video get the shape they are shown in, and it is said."""
    source = VideoSource(written(tmp_path / "dv.mp4", [picture()] * 2, aspect=aspect))
    assert source.size_px == size
    assert next(iter(source)).image.shape == (size[1], size[0], 3)
    assert "not square" in source.notes[0]


def test_interlaced_video_is_taken_apart(tmp_path):
    """Twice as many pictures at twice the rate, each with the column where it was at its own moment."""
    moments = [picture(2 * number) for number in range(24)]
    woven = []
    for first, second in zip(moments[::2], moments[1::2], strict=True):
        image = second.copy()
        image[1::2] = first[1::2]
        woven.append(image)
    path = written(tmp_path / "dv.mp4", woven, 25, options={"x264-params": "bff=1"})
    source = VideoSource(path)
    read = list(source)
    assert source.frame_rate_hz == 50.0
    assert source.frame_count == 24
    assert [frame.time_s for frame in read] == pytest.approx(np.arange(24) / 50, abs=1e-4)
    places = [float(np.mean(np.flatnonzero(frame.image[80, 64:].min(axis=1) > 128))) for frame in read[13:]]
    assert np.diff(places) == pytest.approx(2.0, abs=0.6)
    assert "interlaced" in source.notes[0]


def test_times_of_an_avi_with_reordered_pictures(tmp_path):
    """AVI stores the times in the order of decoding; the pictures come with increasing ones."""
    source = VideoSource(written(tmp_path / "video.avi", [picture(number) for number in range(20)]))
    assert [frame.time_s for frame in source] == pytest.approx(np.arange(20) / 30, abs=1e-6)


def test_slow_motion_runs_at_the_rate_of_taking(tmp_path):
    """A phone's capture rate gives the times; a usual video's, which is its own rate, changes nothing."""
    for captured, step in (("120.0", 1 / 120), ("30.02", 1 / 30), ("7.5", 1 / 7.5)):
        path = written(
            tmp_path / "phone.mp4", [picture()] * 5, metadata={"com.android.capture.fps": captured}
        )
        source = VideoSource(path)
        assert [frame.time_s for frame in source] == pytest.approx(np.arange(5) * step, abs=1e-6)
        assert bool(source.notes) is (step != 1 / 30)


def test_a_raw_stream_needs_its_rate(tmp_path):
    """Pictures without times are refused, unless a rate is given or known otherwise."""
    path = written(tmp_path / "raw.h264", [picture()] * 5, container_format="h264")
    with pytest.raises(TrackerError, match=r"says of no picture when it was taken .* --frame-rate"):
        VideoSource(path)
    for source in (open_recorded(path, 120.0), open_recorded(path, unsaid_hz=120.0)):
        assert [frame.time_s for frame in source] == pytest.approx(np.arange(5) / 120)


def test_a_given_rate_counts_for_every_source(tmp_path):
    """--frame-rate goes before what a video says of itself."""
    path = written(tmp_path / "video.mp4", [picture()] * 5)
    assert [frame.time_s for frame in open_recorded(path, 240.0)] == pytest.approx(np.arange(5) / 240)
    assert [frame.time_s for frame in open_recorded(path, unsaid_hz=240.0)] == pytest.approx(
        np.arange(5) / 30
    )


def _folder(path, names):
    path.mkdir()
    for name in names:
        cv2.imwrite(str(path / name), np.full((8, 8, 3), 90, np.uint8))
    return path


def test_missing_pictures_leave_a_gap(tmp_path):
    """The number in the name is the time; what is missing, also a damaged picture, moves no other."""
    folder = _folder(tmp_path / "run", [f"2026_img_{number:04d}.png" for number in (7, 8, 11, 12, 13)])
    (folder / "2026_img_0014.png").write_bytes(b"no picture")
    (folder / "2026_img_0015.png").write_bytes((folder / "2026_img_0007.png").read_bytes())
    (folder / "._2026_img_0007.png").write_bytes(b"a finder's file")
    source = open_recorded(folder, 10.0)
    assert [frame.time_s for frame in source] == pytest.approx([0.0, 0.1, 0.4, 0.5, 0.6, 0.8])
    assert source.damaged_frames == 1
    assert source.notes == ["2 pictures are missing by their numbers; the others keep their times"]


def test_every_tenth_number_is_a_whole_series(tmp_path):
    """Pictures numbered in steps are a complete series."""
    source = open_recorded(_folder(tmp_path / "run", [f"a{number}.png" for number in (10, 20, 30)]), 10.0)
    assert [frame.time_s for frame in source] == pytest.approx([0.0, 0.1, 0.2])
    assert not source.notes


@pytest.mark.parametrize(
    ("names", "said"),
    [
        ([f"cam{c}_{n}.png" for c in (0, 1) for n in range(3)], "more than one series"),
        ([f"left_{n}.png" for n in range(3)] + [f"right_{n}.png" for n in range(3)], "more than one series"),
        ([f"{n}.png" for n in (1699999999123, 1699999999156, 1699999999190)], "do not count pictures"),
    ],
)
def test_what_is_no_single_series_is_refused(tmp_path, names, said):
    """Two cameras in one folder, or times as names, get a sentence."""
    with pytest.raises(TrackerError, match=said):
        open_recorded(_folder(tmp_path / "run", names), 10.0)


def test_every_page_of_a_stack_is_read(tmp_path):
    """A TIFF stack is a series, named by its file; in a folder it is not taken for one picture."""
    folder = tmp_path / "run"
    folder.mkdir()
    pages = [np.full((8, 8, 3), 40 * number, np.uint8) for number in range(5)]
    cv2.imwritemulti(str(folder / "stack.tif"), pages)
    read = list(open_recorded(folder / "stack.tif", 10.0))
    assert [int(frame.image[0, 0, 0]) for frame in read] == [0, 40, 80, 120, 160]
    assert [frame.time_s for frame in read] == pytest.approx(np.arange(5) / 10)
    with pytest.raises(TrackerError, match="name that file"):
        open_recorded(folder, 10.0)
    with pytest.raises(TrackerError, match="stack of images; say how fast"):
        open_recorded(folder / "stack.tif")
