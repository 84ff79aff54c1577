# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Runs of a simulator that is not ours, with a label each."""

from pathlib import Path

import pytest
from hasel_benchmark.bench_hidden.run_cases import answer
from hasel_sim.model import load_model
from hasel_sysid.dataset import load_experiments, prepared
from hasel_sysid.improvement import improve
from hasel_sysid.problem import Problem

RIG = Path(__file__).resolve().parents[2] / "data" / "unseen_rig"
NEAR_THE_NOISE = 1.15 * 0.0024
"""Mean |Δ sin θ| of normal noise of 0.003 rms, and a little."""
HIDDEN = {
    "quadratic_drag": {"quadratic_drag.coefficient": 0.25},
    "charging_lag": {"charging_lag.charge_time": 0.07, "charging_lag.discharge_time": 0.07},
    "muscle_asymmetry": {"muscle_asymmetry.gain_difference": -0.18},
}
slow = pytest.mark.slow


def improved(case, pool):
    """What `improve` says of one case: fitted on nine runs, judged on three others."""
    fitted = load_experiments(sorted((RIG / case).glob("fit_*.csv")))
    unseen = load_experiments(sorted((RIG / case).glob("val_*.csv")))
    assert (len(fitted), len(unseen)) == (9, 3)
    return answer(load_model("swimmer"), fitted, unseen, pool)


@pytest.mark.timeout(900)
def test_nothing_hidden_is_nothing_missing(pool):
    """No effect is accused, and the model is left as it was fitted."""
    found = improved("nothing_hidden", pool)
    assert found["verdict"]["status"] == "nothing_missing"
    assert found["verdict"]["missing"] == []
    assert [stage["effects"] for stage in found["stages"]] == [[]]
    assert found["stages"][0]["mae_fit"] < NEAR_THE_NOISE


@pytest.mark.timeout(900)
@slow
@pytest.mark.parametrize("effect", ["charging_lag", "quadratic_drag", "muscle_asymmetry"])
def test_hidden_effect_is_named_first_and_added(effect, pool):
    """It leads the ranking, nothing else is added, and the error falls to the noise on fitted and unseen runs."""
    found = improved(effect, pool)
    assert found["ranking"][0]["effect"] == effect
    assert found["verdict"]["missing"] == [effect]
    assert found["verdict"]["status"] == "explained"
    last = found["stages"][-1]
    assert last["effects"] == [effect]
    assert last["mae_fit"] < NEAR_THE_NOISE
    assert last["mae_validation"] < 1.2 * NEAR_THE_NOISE
    for name, truth in HIDDEN[effect].items():
        assert last["parameters"][name]["value"] == pytest.approx(truth, rel=0.15)


@pytest.mark.timeout(300)
def test_four_runs_at_two_voltages_and_two_frequencies_are_enough(pool):
    """Without the drag one of them leaves so much more than the others that the sum scatters more than it is large."""
    fitted, unseen = (
        load_experiments([RIG / "quadratic_drag" / f"{name}.csv" for name in names])
        for names in (
            ("fit_4500V_2.0Hz", "fit_4500V_3.5Hz", "fit_5500V_0.5Hz", "fit_5500V_3.5Hz"),
            ("val_4250V_2.5Hz", "val_5200V_2.5Hz"),
        )
    )
    model = prepared(load_model("swimmer"), fitted)
    only = ("quadratic_drag", "linear_drag")
    found = improve(Problem(fitted, pool), model, Problem(unseen, pool), only).to_json()
    assert found["verdict"]["missing"] == ["quadratic_drag"]
    assert found["verdict"]["set_up"] is None
    last = found["stages"][-1]
    assert last["parameters"]["quadratic_drag.coefficient"]["value"] == pytest.approx(0.25, rel=0.03)
    assert last["mae_validation"] < NEAR_THE_NOISE
