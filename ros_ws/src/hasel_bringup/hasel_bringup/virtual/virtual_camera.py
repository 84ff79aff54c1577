# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 run hasel_bringup virtual_camera`: a swimmer with a secret in a tank, and the camera over it.

The camera has a memory, as high-speed cameras have: where the machine draws pictures fast enough they are sent as they
are exposed, elsewhere once the run is over. Their stamps are those of the exposure either way.
"""

import os
import queue
import threading
import time
from collections.abc import Callable
from functools import partial
from typing import Any

import cv2
import numpy as np
from hasel_common.declared_parameters import declare, words
from hasel_common.endpoints import Role, frame_of, publisher, subscription
from hasel_common.node_process import run_node
from hasel_common.topics import MEASURED, NAMESPACE, STATE
from hasel_interfaces.msg import BendingAngle, SupplyState
from hasel_sim.errors import HaselSimError
from hasel_sim.live.simulator_interface import to_nanoseconds, to_time
from hasel_tracker_lab.rendering.camera_model import CameraView, Degradation
from hasel_tracker_lab.rendering.renderer import Renderer
from hasel_tracker_lab.rendering.swimmer_motion import BodyShape, line_through_markers
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import CompressedImage
from std_srvs.srv import SetBool, Trigger
from threadpoolctl import threadpool_limits

from hasel_bringup.bringup_parameters import VIRTUAL_CAMERA
from hasel_bringup.errors import BringupError
from hasel_bringup.hidden_truth.truth import draw_secret
from hasel_bringup.virtual.seen_swimmer import Exposure, FilmedSwimmer

IMAGES = "camera/image/compressed"
_TRIAL_FRAMES = 30
_REAL_TIME_SHARE = 0.5  # of a frame's time that drawing it may take, as the machine has more to do
_REAL_TIME_CORES = 4  # supply and driver, simulator, camera, tracker
_LATER_NICENESS = 10  # what is drawn after a run must not hold up the supply
_AHEAD = 20  # pictures that may wait at the tracker when they are sent from memory
_PATIENCE_S = 10.0
_JPEG_QUALITY = 92


class VirtualCameraNode(Node):
    """One thread moves the swimmer on and draws; the callbacks only hand over what they heard."""

    def __init__(self) -> None:
        super().__init__("hasel_virtual_camera", namespace=NAMESPACE)
        declare(self, VIRTUAL_CAMERA)
        seed = self._value("seed")
        generator = np.random.default_rng(None if seed < 0 else seed)
        self._secret = draw_secret(words(self, "hidden"), generator)
        self._swimmer = FilmedSwimmer(
            self._secret.model(), self._value("frame_rate"), self._value("ripple"), generator
        )
        self._drawing = Drawing(
            self._value("width"), self._value("height"), self._value("scale"), self._value("noise")
        )
        self._frame_id = frame_of(self, "camera")
        self._images = publisher(self, CompressedImage, IMAGES, Role.SAMPLES)
        self._events: queue.SimpleQueue[Callable[[], object]] = queue.SimpleQueue()
        self._tracked = 0
        self.real_time, sentence = self._judge_speed()
        self.get_logger().info(sentence)
        threading.Thread(target=self._work, name="camera", daemon=True).start()
        alone, slow = MutuallyExclusiveCallbackGroup(), ReentrantCallbackGroup()
        subscription(self, SupplyState, STATE, self._on_state, Role.EVERY_SAMPLE, callback_group=alone)
        subscription(self, BendingAngle, MEASURED, self._on_measured, Role.EVERY_SAMPLE, callback_group=alone)
        self.create_service(SetBool, "camera/capture", self._capture, callback_group=slow)
        self.create_service(Trigger, "camera/speed", partial(self._tell, sentence), callback_group=slow)
        self.create_service(
            Trigger, "camera/reveal", partial(self._tell, str(self._secret)), callback_group=slow
        )

    def _value(self, name: str) -> Any:
        return self.get_parameter(name).value

    def _judge_speed(self) -> tuple[bool, str]:
        """Whether pictures can be drawn as they are exposed, by drawing some; and that in words."""
        self._trial()  # everything compiled and loaded
        per_frame_s = self._trial() / _TRIAL_FRAMES
        share, cores = per_frame_s * self._value("frame_rate"), len(os.sched_getaffinity(0))
        fast = share < _REAL_TIME_SHARE and cores >= _REAL_TIME_CORES
        asked = self._value("real_time")
        real_time = fast if asked == "auto" else asked == "yes"
        measured = f"{1e3 * per_frame_s:.1f} ms per picture, {cores} cores"
        if real_time:
            return True, f"Real time: pictures are sent as they are exposed ({measured})."
        os.nice(_LATER_NICENESS)
        return False, f"Not real time: each run's pictures are drawn, then tracked, after it ({measured})."

    def _trial(self) -> float:
        self._swimmer.put_back()
        begun = time.perf_counter()
        stamp_ns, drawn = 0, 0
        while drawn < _TRIAL_FRAMES:
            for exposure in self._swimmer.state(stamp_ns, np.array([3000.0, 0.0])):
                self._drawing.jpeg(exposure.markers)
                drawn += 1
            stamp_ns += 10_000_000
        return time.perf_counter() - begun

    def _on_state(self, state: SupplyState) -> None:
        voltage = np.nan_to_num(np.array(state.commanded_voltage))
        self._events.put(partial(self._expose, to_nanoseconds(state.header.stamp), voltage))

    def _on_measured(self, _: BendingAngle) -> None:
        self._tracked += 1

    def _capture(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        """True: put the swimmer back and begin; false: end, and answer when every picture has been sent."""
        done = threading.Event()
        self._events.put(partial(self._begin if request.data else self._end, done))
        done.wait()
        response.success, response.message = True, f"{self._sent} pictures"
        return response

    @staticmethod
    def _tell(sentence: str, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.success, response.message = True, sentence
        return response

    # In the camera's thread

    def _work(self) -> None:
        self._kept: list[tuple[int, np.ndarray]] = []
        self._capturing, self._sent, self._tracked_before = False, 0, 0
        with threadpool_limits(1):
            while True:
                self._events.get()()

    def _begin(self, done: threading.Event) -> None:
        self._swimmer.put_back()
        self._capturing, self._kept, self._sent, self._tracked_before = True, [], 0, self._tracked
        done.set()

    def _expose(self, stamp_ns: int, voltage: np.ndarray) -> None:
        if not self._capturing:
            return
        if not self.real_time:
            self._kept.append((stamp_ns, voltage))
            return
        for exposure in self._swimmer.state(stamp_ns, voltage):
            self._send(exposure)

    def _end(self, done: threading.Event) -> None:
        self._capturing = False
        for exposure in self._swimmer.film(self._kept):
            self._await_tracker()
            self._send(exposure)
        self._kept = []
        done.set()

    def _await_tracker(self) -> None:
        """Pictures from memory come no faster than the tracker takes them."""
        end = time.monotonic() + _PATIENCE_S
        while self._sent - (self._tracked - self._tracked_before) > _AHEAD and time.monotonic() < end:
            time.sleep(0.002)

    def _send(self, exposure: Exposure) -> None:
        message = CompressedImage(format="jpeg", data=self._drawing.jpeg(exposure.markers))
        message.header.stamp, message.header.frame_id = to_time(exposure.stamp_ns), self._frame_id
        self._images.publish(message)
        self._sent += 1


class Drawing:
    """Pictures of the swimmer as the camera over the tank takes them.

    width, height [px]; scale [px/m]; noise: standard deviation in grey levels.
    """

    def __init__(self, width: int, height: int, scale: float, noise: float) -> None:
        self._body = _DrawnBody()
        view = CameraView(width, height, scale)
        self._renderer = Renderer(self._body, view, degradation=Degradation(noise_levels=noise))
        self._count = 0

    def jpeg(self, markers: np.ndarray) -> bytes:
        """One picture, with the markers at [3, 2] [m] from its middle."""
        self._body.line = line_through_markers(markers, self._renderer.shape)
        self._count += 1
        image = self._renderer.frame(0.0, self._count).image
        return cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, _JPEG_QUALITY])[1].tobytes()


class _DrawnBody:
    """A motion for the renderer, of which only this moment is known."""

    duration_s = np.inf

    def __init__(self) -> None:
        stations = np.array(BodyShape().marker_stations_m)
        straight = np.column_stack([stations - stations.mean(), np.zeros(3)])
        self.line = line_through_markers(straight, BodyShape())

    def centre_line(self, _: float) -> np.ndarray:
        return self.line


def _spin(node: VirtualCameraNode) -> None:
    executor = MultiThreadedExecutor(num_threads=3)
    executor.add_node(node)
    executor.spin()


def main() -> int:
    """Run the node until it is interrupted; returns the exit code."""
    cv2.setNumThreads(1)
    return run_node(VirtualCameraNode, _spin, errors=(HaselSimError, BringupError))
