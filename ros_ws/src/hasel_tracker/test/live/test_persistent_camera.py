import threading

import numpy as np
import pytest
from hasel_tracker.errors import TrackerError
from hasel_tracker.live.persistent_camera import PersistentCamera
from hasel_tracker.sources.frame import Frame


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
