"""What the stages of an improvement come to."""

import numpy as np
import pytest
from hasel_sim.model import load_model
from hasel_sysid.result import Diagnosis
from hasel_sysid.result import Stage, Status
from hasel_sysid.improvement.conclusion import conclude, left_over
from hasel_sysid.noise.model import NoiseModel
from hasel_sysid.testing.made_up_runs import made_up_fit

FLOOR = 0.0024
NOISE_FLOOR = NoiseModel(white=0.5 * np.pi * FLOOR**2, coloured=0.0, correlation=0.5)
BEAM = load_model("beam")
SOMETHING, NOISE = 0.002, 0.6


def stage(error, *effects, chance=None):
    """A stage with a mean error; chance: of noise alone looking like what it leaves, None if nobody looked."""
    looked = None if chance is None else Diagnosis([], [], NOISE_FLOOR, chance, 0.0, 0.0, 0.0)
    return Stage(effects, made_up_fit(BEAM, error), None, looked)


@pytest.mark.parametrize(
    ("stages", "status", "missing"),
    [
        ([stage(0.0025, chance=NOISE)], Status.NOTHING_MISSING, ()),
        ([stage(0.0444, chance=SOMETHING)], Status.UNEXPLAINED, ()),
        ([stage(0.0444, chance=SOMETHING), stage(0.0025, "drag")], Status.EXPLAINED, ("drag",)),
        # the baseline is far above the noise, whatever no listed effect can do about it
        ([stage(0.0444, chance=NOISE)], Status.UNEXPLAINED, ()),
        # nearly all of a large error is gone, but what is left is not noise
        ([stage(0.0444, chance=SOMETHING), stage(0.0036, "drag")], Status.PARTLY_EXPLAINED, ("drag",)),
        (
            [stage(0.0444, chance=SOMETHING), stage(0.0036, "drag", chance=NOISE)],
            Status.PARTLY_EXPLAINED,
            ("drag",),
        ),
        ([stage(0.0444, chance=SOMETHING), stage(0.0036, *"abc")], Status.PARTLY_EXPLAINED, ("a", "b", "c")),
        ([stage(0.0444, chance=SOMETHING), stage(0.0029, *"abc")], Status.EXPLAINED, ("a", "b", "c")),
        (
            [stage(0.0444, chance=SOMETHING), stage(0.0029, "drag", chance=SOMETHING)],
            Status.EXPLAINED,
            ("drag",),
        ),
        # 96 % of the error, but well above the noise, and a last look still sees something
        (
            [stage(0.0444, chance=SOMETHING), stage(0.0040, "drag", chance=SOMETHING)],
            Status.PARTLY_EXPLAINED,
            ("drag",),
        ),
        ([stage(0.0444, chance=SOMETHING), stage(0.0077, "drag")], Status.PARTLY_EXPLAINED, ("drag",)),
        ([stage(0.0444, chance=SOMETHING), stage(0.0280, "drag")], Status.UNEXPLAINED, ()),
        # a weak effect: the share left is no more than the uncertainty of the noise
        ([stage(0.0030, chance=SOMETHING), stage(0.0026, "a", chance=NOISE)], Status.EXPLAINED, ("a",)),
        (
            [stage(0.0030, chance=SOMETHING), stage(0.0026, "a", chance=SOMETHING)],
            Status.PARTLY_EXPLAINED,
            ("a",),
        ),
    ],
)
def test_status_follows_from_the_mean_error_above_the_noise(stages, status, missing):
    """Explained is what removes nine tenths of it and comes near the noise, or leaves what is found to be noise."""
    found = conclude(stages, "why")
    assert (found.status, found.missing) == (status, missing)


def test_left_over_is_a_share_of_the_baselines_error_above_the_noise():
    """One for the baseline, none at the noise, in proportion between."""
    first = stage(0.0424, chance=SOMETHING)
    assert left_over([first]) == 1.0
    assert left_over([first, stage(FLOOR, "a")]) == 0.0
    assert left_over([first, stage(0.0224, "a")]) == pytest.approx(0.5, abs=0.01)


def test_what_fits_but_contradicts_itself_is_only_part_of_the_truth():
    """An effect that removes everything, but whose value differs from run to run, is not the law."""
    stages = [stage(0.0444, chance=SOMETHING), stage(0.0025, "drag")]
    found = conclude(stages, "why", contradictions=["drag would have to grow."])
    assert (found.status, found.missing) == (Status.PARTLY_EXPLAINED, ("drag",))
    assert str(found).endswith("why\ndrag would have to grow.")
