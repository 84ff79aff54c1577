"""Whether a model describes its runs, and where it does not."""

import numpy as np
import pytest
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.model import load_model
from hasel_sim.run import Run
from hasel_sysid.model_checking.lack_of_fit import goodness_of_fit
from hasel_sysid.noise.model import NoiseModel
from hasel_sysid.testing.made_up_runs import evaluation_of_runs

TIME = np.arange(0, 2.0, 1 / 120)
SWIMMER = load_model("swimmer")
NOISE = NoiseModel(white=4e-6, coloured=5e-6, correlation=0.9)


def _run(voltage, frequency):
    time = np.arange(0, 2.0, 0.5 / frequency)
    upper = np.arange(len(time)) % 2 == 0
    schedule = DriveSchedule(time, voltage * np.stack([upper, ~upper], axis=1))
    return Run(f"{voltage:g}V_{frequency:g}Hz", TIME, schedule)


def _evaluation(seed, missed=lambda run: 0.0):
    runs = [_run(v, f) for v in (3500.0, 4500.0, 5500.0) for f in (1.0, 2.0, 4.0)]
    numbers = np.repeat(np.arange(len(runs)), len(TIME))
    residual = NOISE.sample(numbers, 1, np.random.default_rng(seed))[:, 0]
    residual = residual + np.concatenate([np.broadcast_to(missed(run), len(TIME)) for run in runs])
    jacobian = np.sin(np.arange(len(residual)))[:, None]
    return evaluation_of_runs(runs, residual, jacobian=jacobian, names=("slope",), model=SWIMMER)


def test_noise_alone_is_adequate_in_every_regime():
    """In thirty draws of correlated noise no regime is accused."""
    assert all(goodness_of_fit(_evaluation(seed), NOISE).adequate for seed in range(30))


@pytest.mark.parametrize(
    ("regime", "missed"),
    [
        ("5500 V", lambda run: 0.009 * np.sin(40 * TIME) if "5500V" in run.name else 0.0),
        ("frequency 4 Hz", lambda run: 0.009 * np.sin(40 * TIME) if "_4Hz" in run.name else 0.0),
        ("side lower", lambda run: 0.009 * np.sin(40 * TIME) * (run.schedule.at(TIME)[:, 1] > 0)),
    ],
)
def test_a_law_that_fails_in_one_regime_is_not_adequate(regime, missed):
    """It is told where, though the whole may be near the noise."""
    found = goodness_of_fit(_evaluation(0, missed), NOISE)
    assert not found.adequate
    assert regime in [lack.regime for lack in found.lacking]
    assert "does not describe these runs yet" in str(found)
