# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import time
from dataclasses import replace

import cv2
import numpy as np
import pytest
from hasel_tracker.errors import TrackerError
from hasel_tracker.live_tracker import ERROR, OK, WARN, Health, LiveTracker, TrackingStatistics, judge
from hasel_tracker.sources.frame import Frame
from hasel_tracker.sources.recorded_source import Playback
from hasel_tracker.sources.video_source import VideoSource
from hasel_tracker.tracking.bending_tracker import BendingTracker, TrackedFrame
from hasel_tracker.tracking.marker_set import MarkerSet
from hasel_tracker.video.video_writer import VideoRecorder

QUEUE_SIZE = 4
PATIENCE_S = 100.0  # on a machine that is busy with other things


class SlowTracker(BendingTracker):
    """Takes 20 ms a frame."""

    def update(self, image, time_s):
        time.sleep(0.02)
        return super().update(image, time_s)


def camera(frames, rate_hz: float, as_jpeg: bool = False):
    """Pretend to be a camera: a frame every 1 / rate_hz, stamped; None at the end."""
    left = iter(enumerate(frames))
    start_ns = time.time_ns()

    def read() -> Frame | None:
        index, frame = next(left, (None, None))
        if frame is None:
            return None
        due_ns = start_ns + round(index * 1e9 / rate_hz)
        time.sleep(max((due_ns - time.time_ns()) * 1e-9, 0.0))
        if as_jpeg:
            code = cv2.imencode(".jpg", frame.image, [cv2.IMWRITE_JPEG_QUALITY, 95])[1].tobytes()
            return Frame(index, index / rate_hz, jpeg=code, stamp_ns=time.time_ns())
        return Frame(index, index / rate_hz, image=frame.image, stamp_ns=time.time_ns())

    return read


def run_to_the_end(live: LiveTracker) -> None:
    """Start and wait until all frames are through."""
    live.start()
    end = time.monotonic() + PATIENCE_S
    while live.running and time.monotonic() < end:
        time.sleep(0.01)
    live.stop()


@pytest.mark.parametrize(("as_jpeg", "threads"), [(False, 1), (True, 3)])
def test_every_frame_is_published_in_order(frames, as_jpeg, threads):
    """All frames of a camera, decoded here or by several threads, give their angle in order with their stamp."""
    published = []
    begin, read = time.monotonic(), camera(frames[:40], 60.0, as_jpeg)
    live = LiveTracker(BendingTracker(), lambda f, t: published.append((f, t)), 60, threads, read)
    run_to_the_end(live)
    assert [frame.index for frame, _ in published] == list(range(40))
    angles = [tracked.sin_theta for _, tracked in published]
    assert np.isnan(angles[:2]).all()  # held back until further frames agree
    assert angles[2:] == pytest.approx([frame.sin_theta for frame in frames[2:40]], abs=2e-3)
    health = live.statistics.take()
    assert health.frames == 40
    assert 0.0 < health.mean_latency_s <= health.worst_latency_s < time.monotonic() - begin
    assert live.queue.dropped == 0


def test_slow_tracking_drops_the_oldest_and_counts(frames):
    """When tracking takes longer than a frame, frames are dropped and counted, and none waits longer than a full queue
    takes, however slow the machine."""
    published, done_s = [], [time.monotonic()]

    def publish(frame, _):
        published.append(frame.index)
        done_s.append(time.monotonic())

    live = LiveTracker(SlowTracker(), publish, QUEUE_SIZE, 1, camera(frames[:60], 200.0))
    run_to_the_end(live)
    assert live.queue.dropped == 60 - len(published)
    assert 10 < live.queue.dropped < 58
    assert published == sorted(published)
    assert published[-1] == 59
    slowest_s = max(np.diff(done_s))
    assert live.statistics.take().worst_latency_s < (QUEUE_SIZE + 2) * slowest_s


@pytest.mark.parametrize("as_jpeg", [False, True])
def test_video_is_recorded_on_request(frames, tmp_path, as_jpeg):
    """A recorded video has the frames with their times and the stamp of the first, and tracks to the same angles."""
    angles = {}
    live = LiveTracker(
        BendingTracker(),
        lambda frame, tracked: angles.update({frame.stamp_ns: tracked.sin_theta}),
        60,
        2,
        camera(frames[:40], 60.0, as_jpeg),
    )
    path = tmp_path / "live.mp4"
    live.record(VideoRecorder(path, 60.0))
    with pytest.raises(TrackerError, match="is being recorded already"):
        live.record(VideoRecorder(tmp_path / "second.mp4", 60.0))
    run_to_the_end(live)
    source = VideoSource(path)
    read = list(source)
    assert len(read) == 40
    assert source.start_stamp_ns == min(angles)
    tracker = BendingTracker()
    again = np.array([tracker.update(frame.image, frame.time_s).sin_theta for frame in read])
    seen = np.array([angles[stamp] for stamp in sorted(angles)])
    assert np.isnan(seen).sum() == 2
    assert np.nanmax(np.abs(again - seen)) < 2e-3


def test_recording_without_a_request_is_explained():
    """Stopping a video that was never started says so."""
    live = LiveTracker(BendingTracker(), lambda *_: None)
    with pytest.raises(TrackerError, match="No video is being recorded"):
        live.record_until_now()


def test_broken_pictures_are_counted_and_passed_over(frames):
    """A camera that sends a broken JPEG in between does not stop the tracking."""
    good = cv2.imencode(".jpg", frames[0].image)[1].tobytes()
    codes = iter([good, b"broken", good])
    published = []

    def read() -> Frame | None:
        code = next(codes, None)
        return None if code is None else Frame(0, time.monotonic(), jpeg=code, stamp_ns=time.time_ns())

    live = LiveTracker(BendingTracker(), lambda frame, tracked: published.append(tracked.valid), read=read)
    run_to_the_end(live)
    assert len(published) == 2
    assert live.broken_frames == 1
    assert "not a readable JPEG" in live.fault


def test_playback_keeps_the_time(frames):
    """A recorded run is played at its own speed; stamps are the start plus the frame's time, to the microsecond."""
    recorded = [Frame(k, k * 0.05, image=np.zeros((4, 4, 3), np.uint8)) for k in range(5)]
    playback = Playback(recorded)
    stamps = [frame.stamp_ns for frame in iter(playback.read, None)]
    assert np.diff(stamps) * 1e-9 == pytest.approx([0.05] * 4, abs=1e-6)


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
