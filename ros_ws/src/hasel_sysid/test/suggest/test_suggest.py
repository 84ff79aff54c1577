"""Which run would tell the remaining explanations apart."""

import numpy as np
import pytest
from hasel_sim.model import load_model
from hasel_sim.parallel import executor
from hasel_sim.simulate import simulate
from hasel_sysid.noise.model import NoiseModel
from hasel_sysid.suggest import suggest

NOISE = NoiseModel(white=9e-6, coloured=0.0, correlation=0.5)


@pytest.fixture(scope="module")
def lags():
    """Two models that a slow drive hardly tells apart."""
    model = load_model("swimmer").with_levels(np.array([3500.0, 5500.0]))
    model = model.with_values({"amplitude_3500": 0.027, "amplitude_5500": 0.062, "slope": 0.26})
    return {
        "transport_delay": model.with_effects("transport_delay").with_values({"transport_delay.delay": 0.03}),
        "none": model,
    }


def test_the_best_run_separates_them_most(lags):
    """Ranked by the difference, within the safe maximum, and a full simulation confirms what the draft promises."""
    with executor(1) as pool:
        ranked = suggest(pool, lags, NOISE, 5500.0, brief=True)
    differences = [suggestion.difference for suggestion in ranked]
    assert differences == sorted(differences, reverse=True)
    best = ranked[0]
    assert best.manoeuvre.voltage == 5500.0
    one, other = (simulate(model, best.manoeuvre.run()).sin_theta for model in lags.values())
    assert best.difference == pytest.approx(np.std(one - other) / NOISE.standard_deviation, rel=0.2)
    assert best.to_json()["pairs"][0]["difference"] == best.difference
