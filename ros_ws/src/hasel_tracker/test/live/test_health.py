from dataclasses import replace

import numpy as np
import pytest
from hasel_tracker.live.health import ERROR, OK, WARN, Health, TrackingStatistics, judge
from hasel_tracker.tracking.bending_tracker import TrackedFrame
from hasel_tracker.tracking.marker_set import MarkerSet


def health(rate_hz: float = 120.0, lost_share: float = 0.0, frames: int = 120) -> Health:
    """A second's figures."""
    return Health(frames, rate_hz, 0.005, 0.009, np.full(3, 0.95), lost_share)


@pytest.mark.parametrize(
    ("arguments", "level", "message"),
    [
        ((health(), 120.0, 0, "", ""), OK, "120.0 frames/s, latency 5.0 ms"),
        ((health(115.0), 120.0, 0, "", ""), OK, "115.0 frames/s"),
        ((health(113.0), 120.0, 0, "", ""), WARN, "gives 113.0 frames/s of 120; shorten the exposure"),
        ((health(30.0), None, 0, "", ""), OK, "30.0 frames/s"),
        ((health(), 120.0, 4, "", ""), WARN, "4 frames were dropped"),
        ((health(lost_share=0.25), 120.0, 0, "", ""), WARN, "25 % of the frames had no angle"),
        ((health(), 120.0, 0, "Asked for MJPG, it gives YUYV.", ""), WARN, "it gives YUYV"),
        ((health(frames=0), 120.0, 0, "", ""), ERROR, "No frame arrived; check the camera"),
        ((health(frames=0), 120.0, 0, "", "The cable is out."), ERROR, "The cable is out."),
        ((replace(health(), mean_latency_s=1.8e9), None, 0, "", ""), ERROR, "which cannot be"),
        ((replace(health(), mean_latency_s=-40.0), None, 0, "", ""), ERROR, "which cannot be"),
    ],
)
def test_level_and_sentence(arguments, level, message):
    """A rate below 95 %, drops, lost markers and another format are warnings; no frames at all is an error."""
    report = judge(*arguments)
    assert report.level == level
    assert message in report.message


def test_figures_of_an_interval():
    """Rate, latency and lost share are those of the frames added since the last look, and start anew after it."""
    statistics = TrackingStatistics()
    for index in range(61):
        lost = index % 4 == 0
        tracked = TrackedFrame(
            index / 60, MarkerSet(np.zeros((3, 2)), np.ones(3)), np.nan if lost else 0.1, 0.1
        )
        stamp = round(index * 1e9 / 60)
        statistics.add(tracked, stamp, stamp + (30_000_000 if index == 7 else 10_000_000))
    taken = statistics.take()
    assert taken.frame_rate_hz == pytest.approx(60.0, rel=1e-6)
    assert taken.worst_latency_s == pytest.approx(0.030)
    assert taken.mean_latency_s == pytest.approx(0.010 + 0.020 / 61)
    assert taken.lost_share == pytest.approx(16 / 61)
    assert statistics.take().frames == 0
