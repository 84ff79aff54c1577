"""Judge the live tracker's health: fine, a warning, or an error, in one sentence each."""

from dataclasses import dataclass

from hasel_tracker.live.tracking_statistics import Health
from hasel_tracker.sources.camera_source import RATE_SHARE

OK, WARN, ERROR = "OK", "WARN", "ERROR"  # as hasel_common.diagnostics.Level calls them
POSSIBLE_LATENCY_S = 10.0


@dataclass(frozen=True)
class HealthReport:
    """Level by its name, and what to know."""

    level: str
    message: str


def judge(
    health: Health, asked_rate_hz: float | None, newly_dropped: int, complaint: str, fault: str
) -> HealthReport:
    """The worst first: no frames, a fault, a slow camera, dropped frames, lost markers, another format."""
    if health.frames == 0:
        return HealthReport(ERROR, fault or "No frame arrived; check the camera or the image topic.")
    if not -POSSIBLE_LATENCY_S < health.mean_latency_s < POSSIBLE_LATENCY_S:
        return HealthReport(
            ERROR,
            fault
            or f"Frames are stamped {health.mean_latency_s:.4g} s before their angle is known, which cannot be: set "
            "the camera's clock.",
        )
    warnings = [fault] if fault else []
    if asked_rate_hz is not None and health.frame_rate_hz < RATE_SHARE * asked_rate_hz:
        warnings.append(
            f"The camera gives {health.frame_rate_hz:.1f} frames/s of {asked_rate_hz:g}; "
            "shorten the exposure or ask for a smaller picture."
        )
    if newly_dropped:
        warnings.append(f"{newly_dropped} frames were dropped; the computer is too slow or busy.")
    if health.lost_share > 0.0:
        warnings.append(f"{100 * health.lost_share:.0f} % of the frames had no angle: a marker was lost.")
    if complaint:
        warnings.append(complaint)
    return HealthReport(WARN, " ".join(warnings)) if warnings else HealthReport(OK, str(health))
