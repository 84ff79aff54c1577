# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The node as a user runs it: in a process of its own, spoken to over ROS."""

import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import cv2
import numpy as np
import pytest
import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from hasel_common.declared_parameters import descriptor
from hasel_interfaces.msg import BendingAngle
from hasel_tracker.sources.video_source import VideoSource
from hasel_tracker.tracker_node import angle_message
from hasel_tracker.tracker_parameters import PARAMETERS, SEARCH_NAMES
from hasel_tracker.tracking.bending_tracker import BendingTracker
from hasel_tracker.video.video_writer import JpegWriter
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState
from rcl_interfaces.srv import DescribeParameters, SetParameters
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import CameraInfo, CompressedImage, Image
from std_srvs.srv import SetBool, Trigger

PATIENCE_S = 100.0  # a busy machine takes half a minute to start a node
pytestmark = pytest.mark.timeout(600)


class Observer(Node):
    """Collects what the tracker publishes."""

    def __init__(self) -> None:
        super().__init__("observer")
        self.angles: list[BendingAngle] = []
        self.previews: list[CompressedImage] = []
        self.lenses: list[CameraInfo] = []
        self.reports: list[DiagnosticArray] = []
        self.create_subscription(BendingAngle, "/hasel/bending/measured", self.angles.append, 1000)
        self.create_subscription(
            CompressedImage,
            "/hasel/hasel_tracker/preview/compressed",
            self.previews.append,
            qos_profile_sensor_data,
        )
        self.create_subscription(
            CameraInfo, "/hasel/hasel_tracker/camera_info", self.lenses.append, qos_profile_sensor_data
        )
        self.create_subscription(DiagnosticArray, "/diagnostics", self._note_report, 10)

    def _note_report(self, message: DiagnosticArray) -> None:
        if message.status[0].name.startswith("hasel/hasel_tracker"):
            self.reports.append(message)

    def wait(self, reached: Callable[[], object]) -> None:
        """Spin until something is true; fails after PATIENCE_S."""
        end = time.monotonic() + PATIENCE_S
        while not reached():
            assert time.monotonic() < end, "the tracker did not get there in time"
            rclpy.spin_once(self, timeout_sec=0.05)

    def wait_for_reports(self, count: int) -> None:
        """Spin until so many more reports of the tracker's health have come."""
        wanted = len(self.reports) + count
        self.wait(lambda: len(self.reports) >= wanted)

    def call(self, kind: type, name: str, request: object) -> object:
        """Call a service and return its response."""
        client = self.create_client(kind, name)
        self.wait(lambda: client.service_is_ready())
        future = client.call_async(request)
        self.wait(future.done)
        return future.result()


@pytest.fixture
def observer() -> Iterator[Observer]:
    """A node beside the tracker."""
    rclpy.init()
    node = Observer()
    yield node
    node.destroy_node()
    rclpy.shutdown()


@pytest.fixture
def start() -> Iterator[Callable[..., subprocess.Popen]]:
    """Start a tracker in a process of its own with parameters (name:=value); killed at the end if need be."""
    processes = []

    def started(*parameters: str) -> subprocess.Popen:
        arguments = [part for each in parameters for part in ("-p", each)]
        command = [sys.executable, "-m", "hasel_tracker.tracker_node", "--ros-args", *arguments]
        hear = partial(
            signal.signal, signal.SIGINT, signal.SIG_DFL
        )  # of a run in the background it is ignored
        processes.append(subprocess.Popen(command, stderr=subprocess.PIPE, text=True, preexec_fn=hear))
        return processes[-1]

    yield started
    for process in processes:
        process.kill()
        process.communicate()


def stopped(process: subprocess.Popen) -> str:
    """Interrupt the tracker as Ctrl-C does; returns what it said on stderr."""
    process.send_signal(signal.SIGINT)
    return process.communicate(timeout=PATIENCE_S)[1]


def image_message(image: np.ndarray, stamp_s: int) -> Image:
    """An image as a camera node would publish it."""
    message = Image(height=image.shape[0], width=image.shape[1], encoding="bgr8", step=3 * image.shape[1])
    message.data = image.tobytes()
    message.header.stamp.sec = stamp_s
    return message


@pytest.fixture
def long_video(frames, tmp_path) -> Path:
    """The beat to and fro for twenty seconds, long enough for nodes to find each other."""
    codes = [cv2.imencode(".jpg", frame.image)[1].tobytes() for frame in frames]
    there_and_back = codes + codes[-2:0:-1]
    writer = JpegWriter(tmp_path / "long.mp4", 120.0)
    for index in range(2400):
        writer.write_jpeg(there_and_back[index % len(there_and_back)], (640, 360))
    writer.close()
    return tmp_path / "long.mp4"


def test_video_becomes_angles_preview_and_diagnostics(observer, start, long_video, frames):
    """A played video gives the true angles with increasing stamps, a small annotated picture, and a report."""
    process = start(f"source:={long_video}", "preview_width:=320")
    observer.wait(lambda: len(observer.angles) >= 40 and observer.previews and len(observer.reports) >= 2)
    assert stopped(process).count("Traceback") == 0
    assert process.returncode == 0
    truth = np.array([frame.sin_theta for frame in frames])
    valid = [message for message in observer.angles if message.valid]
    assert all(message.doubt for message in observer.angles if not message.valid)
    assert len(valid) > 0.7 * len(observer.angles)
    assert max(np.abs(truth - message.sin_theta).min() for message in valid) < 0.01
    assert max(message.sin_theta for message in valid) > 0.3
    stamps = [message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec for message in observer.angles]
    assert (np.diff(stamps) > 0).all()
    assert abs(stamps[-1] - time.time()) < 60.0
    picture = cv2.imdecode(np.frombuffer(observer.previews[0].data, np.uint8), cv2.IMREAD_COLOR)
    assert picture.shape == (180, 320, 3)
    assert (observer.lenses[0].height, observer.lenses[0].width) == (180, 320)
    assert observer.lenses[0].header.frame_id == observer.previews[0].header.frame_id
    keys = {value.key for value in observer.reports[0].status[0].values}
    assert {"frame rate [1/s]", "mean latency [ms]", "dropped frames", "quality of head"} <= keys


def test_the_lifecycle_stops_and_starts_the_tracking(observer, start, long_video):
    """Nothing is tracked before it is active nor after; a file is played again from its beginning."""

    def change(transition: int) -> bool:
        request = ChangeState.Request(transition=Transition(id=transition))
        return observer.call(ChangeState, "/hasel/hasel_tracker/change_state", request).success

    process = start(f"source:={long_video}", "autostart:=false")
    record = SetBool.Request(data=True)
    refused = observer.call(SetBool, "/hasel/hasel_tracker/record_video", record)
    assert (refused.success, "activate the node" in refused.message) == (False, True)
    assert change(Transition.TRANSITION_CONFIGURE)
    assert observer.angles == []
    for _ in range(2):
        before = len(observer.angles)
        assert change(Transition.TRANSITION_ACTIVATE)
        observer.wait(lambda before=before: len(observer.angles) > before + 20)
        assert change(Transition.TRANSITION_DEACTIVATE)
        observer.wait_for_reports(2)  # meanwhile what was under way arrives
        resting = len(observer.angles)
        observer.wait_for_reports(2)
        assert "Not active" in observer.reports[-1].status[0].message
        assert len(observer.angles) == resting
    assert "Traceback" not in stopped(process)
    assert process.returncode == 0


def test_image_topic_services_and_parameters(observer, start, frames, tmp_path):
    """Images from a topic are tracked; a lost marker is NaN; video is recorded on request; settings are checked."""
    images = observer.create_publisher(Image, "/camera/image_raw", 10)
    now = int(time.time()) - 5
    process = start("source:=topic:/camera/image_raw", f"video_folder:={tmp_path}")
    observer.wait(lambda: images.get_subscription_count() >= 1)
    observer.wait(lambda: observer.count_publishers("/hasel/bending/measured") >= 1)

    def show(image: np.ndarray, stamp_s: int) -> BendingAngle:
        images.publish(image_message(image, stamp_s))
        observer.wait(lambda: any(each.header.stamp.sec == stamp_s for each in observer.angles))
        return observer.angles[-1]

    started_video = observer.call(SetBool, "/hasel/hasel_tracker/record_video", SetBool.Request(data=True))
    assert started_video.success
    assert show(frames[40].image, now).doubt == BendingAngle.STARTING
    assert not show(frames[40].image, now + 1).valid
    seen = show(frames[40].image, now + 2)
    assert seen.valid
    assert seen.header.stamp.sec == now + 2
    assert [*seen.marker_name] == ["head", "middle", "tail"]
    assert 0.0 < seen.sin_theta_standard_deviation < 0.01
    assert seen.sin_theta == pytest.approx(frames[40].sin_theta, abs=2e-3)
    assert [*seen.marker_x] == pytest.approx(frames[40].markers_px[:, 0], abs=0.2)

    blank = show(np.full_like(frames[0].image, 190), now + 3)
    assert not blank.valid
    assert np.isnan([blank.sin_theta, blank.theta, *blank.marker_x, *blank.marker_y]).all()
    assert [*blank.marker_quality] == [0.0, 0.0, 0.0]

    finished = observer.call(SetBool, "/hasel/hasel_tracker/record_video", SetBool.Request(data=False))
    assert finished.success
    source = VideoSource(Path(started_video.message))
    assert len(list(source)) == 4
    assert source.start_stamp_ns == now * 10**9
    assert not observer.call(
        SetBool, "/hasel/hasel_tracker/record_video", SetBool.Request(data=False)
    ).success

    def set_parameter(name: str, value: object) -> object:
        request = SetParameters.Request(parameters=[Parameter(name, value=value).to_parameter_msg()])
        return observer.call(SetParameters, "/hasel/hasel_tracker/set_parameters", request).results[0]

    refused = set_parameter("head", "north")
    assert not refused.successful
    assert "expected auto, left" in refused.reason
    assert not set_parameter("width", 640).successful
    assert set_parameter("hue_low", 40).successful
    assert set_parameter("hue_high", 80).successful
    assert not show(frames[40].image, now + 4).valid  # blue markers are not looked for any more
    assert set_parameter("hue_high", 130).successful
    assert observer.call(Trigger, "/hasel/hasel_tracker/restart", Trigger.Request()).success
    assert [show(frames[40].image, stamp_s).valid for stamp_s in (now + 5, now + 6, now + 7)] == [
        False,
        False,
        True,
    ]
    show(frames[40].image, now + 11)  # three images between the stamps never came
    lost = "3 frames were dropped"
    observer.wait(lambda: any(lost in report.status[0].message for report in observer.reports))
    assert (
        next(r for r in observer.reports if lost in r.status[0].message).status[0].level
        == DiagnosticStatus.WARN
    )

    request = DescribeParameters.Request(names=["frame_rate"])
    described = observer.call(
        DescribeParameters, "/hasel/hasel_tracker/describe_parameters", request
    ).descriptors[0]
    assert described.read_only
    assert described.floating_point_range[0].to_value == 1000.0
    assert "[1/s]" in described.description
    assert "Traceback" not in stopped(process)


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        (["source:=/nowhere/video.mp4"], "/nowhere/video.mp4 does not exist"),
        (["source:=/dev/video97"], "The camera /dev/video97 cannot be opened"),
        (["source:=topic:/x", "head:=north"], "expected auto"),
        (["source:=topic:/x", "calibration:=none.yaml"], "The calibration none.yaml cannot be read"),
    ],
)
def test_impossible_start_ends_with_one_sentence(start, parameters, message):
    """A node that cannot start says why in one sentence and exits with 1."""
    process = start(*parameters)
    _, error = process.communicate(timeout=PATIENCE_S)
    assert process.returncode == 1
    assert "Traceback" not in error
    assert f"error: {message}" in error or message in error


def test_angle_message_of_a_frame(frames):
    """The message has the frame's stamp to the nanosecond, pixels and qualities in the order head, middle, tail."""
    tracked = BendingTracker().update(frames[30].image, 0.25, frames[30].markers_px)
    message = angle_message(tracked, 1_700_000_000_123_456_789, "camera")
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == (1_700_000_000, 123_456_789)
    assert message.header.frame_id == "camera"
    assert message.marker_x[0] < message.marker_x[1] < message.marker_x[2]
    assert message.valid


@pytest.mark.parametrize("parameter", PARAMETERS, ids=lambda each: each.name)
def test_parameters_are_described_and_within_their_range(parameter):
    """Every parameter has a meaning, and its default lies within the range or choices it states."""
    told = descriptor(parameter)
    assert told.description
    assert told.read_only is not parameter.changeable
    if parameter.low is not None:
        assert parameter.low <= parameter.default <= parameter.high
    if parameter.choices:
        assert parameter.default in parameter.choices


def test_every_setting_of_the_search_is_a_parameter():
    """What `calibrate colour` writes can all be given to the node."""
    assert set(SEARCH_NAMES) == {each.name for each in PARAMETERS if each.changeable}
