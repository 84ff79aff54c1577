"""Corrections by hand."""

import numpy as np
import pytest
from hasel_tracker.errors import TrackerError
from hasel_tracker.offline.fixes import read_fixes
from hasel_tracker.offline.tracked_run import track_frames
from hasel_tracker.sources.frame import Frame
from hasel_tracker.tracking.bending_tracker import BendingTracker


def test_a_fix_turns_a_swimmer_round(frames, tmp_path):
    """From the frame that a fix names on, head and tail are where the person says, without doubt."""
    points = frames[5].markers_px[::-1].round().astype(int).tolist()
    path = tmp_path / "fix.yaml"
    path.write_text(f"- {{frame: 5, at: {points}}}\n")
    pictures = [Frame(index, frame.time_s, image=frame.image) for index, frame in enumerate(frames[:10])]
    run = track_frames(pictures, BendingTracker(), placed=read_fixes(path))
    assert run.valid.all()
    truth = np.array([frame.markers_px for frame in frames[:10]])
    assert np.abs(run.markers_px[:5] - truth[:5]).max() < 0.2
    assert np.abs(run.markers_px[5:] - truth[5:, ::-1]).max() < 0.2


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{}", "are not a list"),
        ("- {frame: 3}", "expected a frame and its markers"),
        ("- {frame: -1, at: [[1, 2]]}", "expected a frame and its markers"),
        ("- [", "cannot be read"),
    ],
)
def test_unreadable_fixes_are_explained(tmp_path, text, message):
    """What is wrong with a file of corrections is one sentence with an example."""
    (tmp_path / "fix.yaml").write_text(text)
    with pytest.raises(TrackerError, match=message):
        read_fixes(tmp_path / "fix.yaml")


def test_a_fix_beside_the_dots_or_the_video_is_refused(frames):
    """A point where there is no dot, or a frame that the video does not have, is named."""
    pictures = [Frame(index, frame.time_s, image=frame.image) for index, frame in enumerate(frames[:3])]
    with pytest.raises(TrackerError, match="No dot of marker colour is at 10,20"):
        track_frames(pictures, BendingTracker(), placed={0: np.array([[10, 20], [300, 100], [500, 100]])})
    with pytest.raises(TrackerError, match="for frame 9, but the source has 3 frames"):
        track_frames(pictures, BendingTracker(), placed={9: frames[0].markers_px})
