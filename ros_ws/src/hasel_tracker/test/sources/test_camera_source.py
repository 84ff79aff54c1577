# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import threading
import time

import cv2
import numpy as np
import pytest
from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.camera_source import CameraFormat, CameraSource, PersistentCamera
from hasel_tracker.sources.frame import Frame


class FakeCapture:
    """Behaves as a V4L2 camera through OpenCV: 60 frames/s at most, raw JPEG if no conversion is wanted."""

    def __init__(self, opened: bool = True, driver_age_s: float | None = 0.02) -> None:
        self.settings: list[int] = []
        self.values: dict[int, float] = {}
        self.opened = opened
        self.driver_age_s = driver_age_s
        self.picture = np.full((48, 64, 3), 90, np.uint8)
        self.left = 3

    def isOpened(self) -> bool:
        return self.opened

    def set(self, name: int, value: float) -> bool:
        self.settings.append(name)
        self.values[name] = min(value, 60.0) if name == cv2.CAP_PROP_FPS else value
        return True

    def get(self, name: int) -> float:
        if name == cv2.CAP_PROP_POS_MSEC:
            return 0.0 if self.driver_age_s is None else 1e3 * (time.monotonic() - self.driver_age_s)
        return float(self.values.get(name, 0.0))

    def read(self) -> tuple[bool, np.ndarray | None]:
        if self.left == 0:
            return False, None
        self.left -= 1
        if self.values.get(cv2.CAP_PROP_CONVERT_RGB) == 0:
            return True, cv2.imencode(".jpg", self.picture)[1].reshape(1, -1)
        return True, self.picture

    def release(self) -> None:
        self.opened = False


def test_pixel_format_is_asked_for_before_size_and_rate():
    """The four-character code comes first, since it decides which sizes and rates the camera has."""
    capture = FakeCapture()
    CameraSource(0, CameraFormat(), capture=capture)
    wanted = [cv2.CAP_PROP_FOURCC, cv2.CAP_PROP_FRAME_WIDTH, cv2.CAP_PROP_FRAME_HEIGHT, cv2.CAP_PROP_FPS]
    assert [each for each in capture.settings if each in wanted] == wanted


def test_what_the_camera_gives_is_read_back_and_complained_about():
    """A camera that gives 60 instead of 120 frames/s is found out at once."""
    camera = CameraSource(0, CameraFormat(1920, 1080, 120.0, "MJPG"), capture=FakeCapture())
    assert camera.given == CameraFormat(1920, 1080, 60.0, "MJPG")
    assert camera.complaint == (
        "Asked the camera for 1920 × 1080 px MJPG at 120 frames/s, it gives 1920 × 1080 px MJPG at 60 frames/s."
    )
    assert CameraSource(0, CameraFormat(640, 480, 30.0), capture=FakeCapture()).complaint == ""


def test_jpeg_is_passed_on_undecoded():
    """An MJPEG camera's pictures stay JPEG until decoded elsewhere, and then are the picture."""
    frame = CameraSource(0, CameraFormat(64, 48, 30.0, "MJPG"), capture=FakeCapture()).read()
    assert frame.image is None
    assert frame.decoded().image == pytest.approx(np.full((48, 64, 3), 90), abs=3)


def test_decoded_cameras_give_images():
    """Another pixel format arrives as an image."""
    frame = CameraSource(0, CameraFormat(64, 48, 30.0, "YUYV"), capture=FakeCapture()).read()
    assert frame.jpeg is None
    assert frame.image.shape == (48, 64, 3)


@pytest.mark.parametrize(("driver_age_s", "expected_s"), [(0.02, 0.02), (None, 0.0), (3600.0, 0.0)])
def test_stamp_is_the_drivers_where_it_makes_sense(driver_age_s, expected_s):
    """The stamp is the driver's moment of exposure; without one, or with nonsense, the time of arrival."""
    frame = CameraSource(0, CameraFormat(), capture=FakeCapture(driver_age_s=driver_age_s)).read()
    assert time.time() - frame.stamp_ns * 1e-9 == pytest.approx(expected_s, abs=0.015)


def test_end_of_the_camera_gives_none():
    """When the camera fails, read says so instead of repeating the last frame."""
    camera = CameraSource(0, CameraFormat(), capture=FakeCapture())
    frames = [camera.read() for _ in range(4)]
    assert [frame and frame.index for frame in frames] == [0, 1, 2, None]


def test_absent_camera_is_explained():
    """A camera that cannot be opened gives one sentence with what to check."""
    with pytest.raises(TrackerError, match="camera 7 cannot be opened; check that it is plugged in"):
        CameraSource(7, capture=FakeCapture(opened=False))


def test_a_rate_that_a_driver_rounds_is_no_complaint():
    """119.98 frames/s for 120 is what was asked for; 100 is not."""
    camera = CameraSource(0, CameraFormat(640, 480, 30.0), capture=FakeCapture())
    camera.asked, camera.given = CameraFormat(), CameraFormat(frame_rate_hz=119.98)
    assert camera.complaint == ""
    camera.given = CameraFormat(frame_rate_hz=100.0)
    assert "it gives" in camera.complaint


class PluggedCamera:
    """Gives two frames, then fails."""

    def __init__(self) -> None:
        self.left = 2
        self.closed = False

    def read(self) -> Frame | None:
        self.left -= 1
        return Frame(0, 0.0, image=np.zeros((4, 4, 3), np.uint8)) if self.left >= 0 else None

    def close(self) -> None:
        self.closed = True


def test_camera_is_opened_again_when_it_comes_back():
    """After the camera fails it is released and tried again until it opens; frames then go on."""
    opened = []

    def open_camera() -> PluggedCamera:
        if len(opened) in (1, 2):
            opened.append(None)
            raise TrackerError("The camera 0 cannot be opened.")
        opened.append(PluggedCamera())
        return opened[-1]

    camera = PersistentCamera(open_camera, retry_s=0.01)
    assert all(camera.read() is not None for _ in range(4))
    assert len(opened) == 4
    assert opened[0].closed
    assert camera.fault == ""


def test_fault_says_what_is_wrong_while_waiting():
    """While the camera is gone its fault is known, and closing ends the waiting."""
    first = [PluggedCamera()]

    def open_camera() -> PluggedCamera:
        if first:
            return first.pop()
        raise TrackerError("The camera 0 cannot be opened.")

    camera = PersistentCamera(open_camera, retry_s=0.01)
    camera.read()
    camera.read()
    threading.Timer(0.1, camera.close).start()
    assert camera.read() is None
    assert camera.fault == "The camera 0 cannot be opened."


def test_camera_absent_from_the_start_is_an_error():
    """A node started without its camera fails at once instead of waiting."""

    def open_camera() -> PluggedCamera:
        raise TrackerError("The camera 0 cannot be opened.")

    with pytest.raises(TrackerError, match="cannot be opened"):
        PersistentCamera(open_camera)
