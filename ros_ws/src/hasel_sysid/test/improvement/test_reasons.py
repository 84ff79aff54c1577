"""Why a stage is the last one."""

from dataclasses import replace

from hasel_sysid.data_gate.finding import error
from hasel_sysid.improvement.reasons import why_the_last
from hasel_sysid.policy import POLICY


def test_faults_of_the_set_up_are_told_one_sentence_each():
    """They come before any effect, and nothing else is told."""
    fault = error("mirrored", -0.9, "moves against the model", "look at the camera")
    faults = [replace(fault, recording=name) for name in ("first", "second")]
    reason, done = why_the_last(None, None, POLICY, None, faults, None)
    assert not done
    assert reason == (
        "A fault of the set-up comes before any effect: first: mirrored: moves against the model; look at the camera. "
        "second: mirrored: moves against the model; look at the camera."
    )
