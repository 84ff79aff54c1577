# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The ROS node: camera in, bending angle out; images stay in this process."""

import signal
import sys
import time
from datetime import datetime
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import rclpy
from builtin_interfaces.msg import Time
from hasel_common.command_entry import end_with_parent
from hasel_common.declared_parameters import declare
from hasel_common.diagnostics import Diagnostics, Level, Part
from hasel_common.endpoints import STEADY, Role, frame_of, publisher
from hasel_common.managed_node import ManagedNode, start_and_spin
from hasel_common.topics import MEASURED, NAMESPACE
from hasel_interfaces.msg import BendingAngle
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import CameraInfo, CompressedImage
from std_srvs.srv import SetBool, Trigger

from hasel_tracker.calibration.camera_calibration import CameraCalibration
from hasel_tracker.calibration.camera_info import camera_info
from hasel_tracker.errors import TrackerError
from hasel_tracker.image_topic import ImageTopic
from hasel_tracker.live_tracker import LiveTracker, health_values, judge
from hasel_tracker.sources.camera_source import CameraFormat, CameraSource, PersistentCamera
from hasel_tracker.sources.frame import Frame
from hasel_tracker.sources.recorded_source import Playback, open_recorded
from hasel_tracker.tracker_parameters import PARAMETERS, SEARCH_NAMES
from hasel_tracker.tracking.bending_tracker import BendingTracker, TrackedFrame
from hasel_tracker.tracking.tracker_settings import settings_from
from hasel_tracker.video.annotation import preview
from hasel_tracker.video.video_writer import VideoRecorder

TOPIC_PREFIX = "topic:"
PREVIEW_JPEG_QUALITY = 70


class TrackerNode(ManagedNode):
    """Publishes the bending angle of every frame, a preview, and diagnostics; records video on request.

    Inactive, the source is open and nothing is tracked; a file or folder is played from its beginning when active.
    """

    expected_errors = (TrackerError,)

    def __init__(self) -> None:
        super().__init__("hasel_tracker", namespace=NAMESPACE)
        declare(self, PARAMETERS)
        self._angles = publisher(self, BendingAngle, MEASURED, Role.SAMPLES)
        self._previews = publisher(self, CompressedImage, "~/preview/compressed", Role.PICTURES)
        self._lenses = publisher(self, CameraInfo, "~/camera_info", Role.PICTURES)
        self._diagnostics = Diagnostics(self, Part.TRACKING)
        self._next_preview_s = 0.0
        self._reported_drops = 0
        self._topic: ImageTopic | None = None
        self._last_note = ""
        self._camera: PersistentCamera | None = None
        self._live: LiveTracker | None = None
        self.add_on_set_parameters_callback(self._check_settings)
        self.add_post_set_parameters_callback(self._apply_settings)
        self.create_service(SetBool, "~/record_video", self._record_video)
        self.create_service(Trigger, "~/restart", self._restart)
        self.create_timer(1.0, self._report, clock=STEADY)

    # Lifecycle

    def configure(self) -> None:
        """Open the source."""
        source, read = self._value("source"), None
        if source.isdigit() or source.startswith("/dev/"):
            self._camera = PersistentCamera(self._open_camera)
            read = self._camera.read
        elif not source.startswith(TOPIC_PREFIX):
            read = Playback(open_recorded(source, unsaid_hz=self._value("frame_rate"))).read
        self._live = LiveTracker(
            self._new_tracker({}),
            self._publish,
            self._value("queue_size"),
            self._value("decode_threads"),
            read,
        )

    def activate(self) -> None:
        """Capture and track."""
        if self._live is None:
            self.configure()
        source = self._value("source")
        if source.startswith(TOPIC_PREFIX):
            self._topic = ImageTopic(self, source.removeprefix(TOPIC_PREFIX), self._tracking)
        self._reported_drops = 0
        self._tracking().start()

    def deactivate(self) -> None:
        """Stop the threads and finish a video being recorded."""
        if self._topic is not None:
            self._topic.close()
        if self._camera is not None:
            self._camera.close()
        if self._live is not None:
            self._live.stop()
        if self._camera is not None:
            self._camera.release()
        self._topic = self._camera = self._live = None

    cleanup = deactivate
    close = deactivate

    def _tracking(self) -> LiveTracker:
        if self._live is None:
            raise TrackerError("Nothing is tracked: activate the node (lifecycle) first.")
        return self._live

    def _value(self, name: str) -> Any:
        return self.get_parameter(name).value

    def _open_camera(self) -> CameraSource:
        source, exposure = self._value("source"), self._value("exposure")
        asked = CameraFormat(
            *(self._value(name) for name in ("width", "height", "frame_rate", "pixel_format"))
        )
        camera = CameraSource(
            int(source) if source.isdigit() else source, asked, None if exposure < 0.0 else exposure
        )
        self.get_logger().info(f"The camera gives {camera.given}.")
        return camera

    def _new_tracker(self, changed: dict[str, object]) -> BendingTracker:
        values = {name: self._value(name) for name in SEARCH_NAMES} | changed
        calibration = self._value("calibration")
        return BendingTracker(
            settings_from(values),
            self._value("method"),
            CameraCalibration.load(Path(calibration)) if calibration else None,
            self._value("mirrored"),
            roi=_region(self._value("roi")),
            start_at=_points(self._value("at")),
        )

    def _publish(self, frame: Frame, tracked: TrackedFrame) -> None:
        frame_id = frame_of(self, self._value("frame_id"))
        self._angles.publish(angle_message(tracked, frame.stamp_ns, frame_id))
        live = self._live
        if live is not None and live.tracker.note != self._last_note:
            self._last_note = live.tracker.note
            self.get_logger().info(f"Markers: {self._last_note}.")
        rate = self._value("preview_rate")
        if rate > 0.0 and time.monotonic() >= self._next_preview_s:
            self._next_preview_s = time.monotonic() + 1.0 / rate
            picture = preview(frame.image, tracked, self._value("preview_width"))
            _, jpeg = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, PREVIEW_JPEG_QUALITY])
            message = compressed_image(jpeg.tobytes(), frame.stamp_ns, frame_id)
            self._previews.publish(message)
            lens = None if live is None else live.tracker.calibration
            self._lenses.publish(camera_info(lens, picture.shape[1::-1], message.header))

    def _report(self) -> None:
        if self.active and self._live is not None:
            self._tell_health(self._live)
        else:
            self._diagnostics.tell(Level.OK, "Not active: nothing is tracked.", {}, "camera")

    def _tell_health(self, live: LiveTracker) -> None:
        health = live.statistics.take()
        dropped = live.queue.dropped + (0 if self._topic is None else self._topic.lost)
        camera = None if self._camera is None else self._camera.camera
        fault = live.fault or ("" if self._camera is None else self._camera.fault)
        live.fault = ""
        if not live.running:
            fault = "The source has ended; deactivate and activate the node to play it again."
        report = judge(
            health,
            None if camera is None else camera.asked.frame_rate_hz,
            dropped - self._reported_drops,
            "" if camera is None else camera.complaint,
            fault,
        )
        self._reported_drops = dropped
        details: dict[str, Any] = {"dropped frames": dropped, "broken frames": live.broken_frames}
        if camera is not None:
            details["camera"] = camera.given
        if live.recording is not None:
            details["recording"] = live.recording.path
        self._diagnostics.tell(Level[report.level], report.message, health_values(health) | details, "camera")

    def _record_video(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        try:
            if request.data:
                path = Path(self._value("video_folder")) / f"swimmer_{datetime.now():%Y%m%d_%H%M%S_%f}.mp4"
                self._tracking().record(VideoRecorder(path, self._value("frame_rate")))
                response.message = str(path)
            else:
                response.message = self._tracking().record_until_now()
            response.success = True
        except TrackerError as error:
            response.success, response.message = False, str(error)
        return response

    def _restart(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        if self._live is not None:
            self._live.tracker = self._new_tracker({})
        response.success, response.message = True, "The markers are searched anew."
        return response

    def _check_settings(self, parameters: list[Parameter]) -> SetParametersResult:
        changed = {each.name: each.value for each in parameters if each.name in SEARCH_NAMES}
        try:
            self._new_tracker(changed)
        except TrackerError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _apply_settings(self, parameters: list[Parameter]) -> None:
        if self._live is not None and any(each.name in SEARCH_NAMES for each in parameters):
            self._live.tracker = self._new_tracker({})


def _region(text: str) -> tuple[int, int, int, int] | None:
    try:
        x, y, width, height = (int(part) for part in text.split(",")) if text else (0,) * 4
    except ValueError:
        raise TrackerError(f"The parameter roi is '{text}'; expected X,Y,WIDTH,HEIGHT in pixels.") from None
    return (x, y, width, height) if text else None


def _points(text: str) -> np.ndarray | None:
    try:
        points = np.array([[float(part) for part in word.split(",")] for word in text.split()])
    except ValueError:
        points = np.zeros(1)
    if text and (points.ndim != 2 or points.shape[1] != 2):
        raise TrackerError(f"The parameter at is '{text}'; expected X,Y X,Y … in pixels, head first.")
    return points if text else None


def stamp(stamp_ns: int) -> Time:
    """A time since the epoch [ns] as a message."""
    return Time(sec=stamp_ns // 1_000_000_000, nanosec=stamp_ns % 1_000_000_000)


def angle_message(tracked: TrackedFrame, stamp_ns: int, frame_id: str) -> BendingAngle:
    """The bending angle of a frame captured at `stamp_ns`; NaN and not valid if a marker was lost or in doubt."""
    message = BendingAngle()
    message.header.stamp, message.header.frame_id = stamp(stamp_ns), frame_id
    message.sin_theta, message.theta, message.valid = tracked.sin_theta, tracked.theta, tracked.valid
    message.sin_theta_standard_deviation = tracked.sin_theta_std
    message.doubt = int(tracked.markers.doubt)
    message.marker_name = list(tracked.markers.names)
    message.marker_x = tracked.markers.positions[:, 0].tolist()
    message.marker_y = tracked.markers.positions[:, 1].tolist()
    message.marker_quality = tracked.markers.quality.tolist()
    if tracked.positions_m is not None:
        message.marker_x_m = tracked.positions_m[:, 0].tolist()
        message.marker_y_m = tracked.positions_m[:, 1].tolist()
    return message


def compressed_image(jpeg: bytes, stamp_ns: int, frame_id: str) -> CompressedImage:
    """A JPEG picture as a message."""
    message = CompressedImage(format="jpeg", data=jpeg)
    message.header.stamp, message.header.frame_id = stamp(stamp_ns), frame_id
    return message


def main() -> int:
    """Run the node until it is interrupted; returns the exit code."""
    # ROS must stay up until the tracking thread has stopped, so the signals are ours.
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    end_with_parent()
    node = None
    try:
        node = TrackerNode()
        start_and_spin(node)
    except TrackerError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        if node is not None:
            node.close()
            node.destroy_node()
        rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
