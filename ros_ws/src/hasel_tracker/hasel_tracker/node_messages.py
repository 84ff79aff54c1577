"""Results as ROS messages."""

from typing import Any

from builtin_interfaces.msg import Time
from hasel_interfaces.msg import BendingAngle
from sensor_msgs.msg import CompressedImage

from hasel_tracker.live.tracking_statistics import Health
from hasel_tracker.tracking.bending_tracker import TrackedFrame
from hasel_tracker.tracking.marker_set import marker_names


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


def health_values(health: Health) -> dict[str, Any]:
    """What `/diagnostics` says of the frames since it was last asked."""
    names = marker_names(len(health.quality)) if health.frames else ()
    return {
        "frame rate [1/s]": f"{health.frame_rate_hz:.2f}",
        "mean latency [ms]": f"{1e3 * health.mean_latency_s:.2f}",
        "worst latency [ms]": f"{1e3 * health.worst_latency_s:.2f}",
        "frames without angle": f"{health.lost_share:.3f}",
        **{f"quality of {name}": f"{value:.2f}" for name, value in zip(names, health.quality, strict=True)},
    }
