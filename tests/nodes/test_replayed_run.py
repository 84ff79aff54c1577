# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Simulator, identification and replay as three processes on real DDS, against `simulate` on the same file."""

from pathlib import Path

import numpy as np
import pytest
from hasel_bringup.processes import Processes
from hasel_interfaces.srv import FitModel, LoadModel
from hasel_sim.model import load_model, save_model
from hasel_sim.parallel import SerialExecutor
from hasel_sysid.dataset import load_experiments
from hasel_sysid.problem import Problem

from tests.nodes.listener import Listener, stamp_ns

RUNS = Path(__file__).resolve().parents[2] / "data" / "unseen_rig" / "quadratic_drag"
RUN = RUNS / "fit_5500V_2.0Hz.csv"
FITTED = {"amplitude_3500": 0.027, "amplitude_4500": 0.044, "amplitude_5500": 0.062, "slope": 0.27}
TOLERANCE = 1e-6
"""On the mean |Δ sin θ|: stamps are whole nanoseconds, and both sum in another order."""


@pytest.fixture
def model_file(tmp_path) -> Path:
    """A model with amplitudes for the voltages of the runs."""
    path = tmp_path / "model.yaml"
    save_model(
        load_model("swimmer").with_levels(np.array([3500.0, 4500.0, 5500.0])).with_values(FITTED), path
    )
    return path


@pytest.fixture
def stack(tmp_path, environment, listener, model_file):
    """Simulator and identification, ready and connected to each other."""
    with Processes(tmp_path, environment) as stack:
        model = ("--ros-args", "-p", f"model:={model_file}")
        stack.start("hasel_sim", "simulator", *model, "-p", f"own_files:={tmp_path}")
        stack.start("hasel_sysid", "sysid", *model, "-p", f"output:={tmp_path}")

        def connected() -> bool:
            heard = listener.diagnostics.get("hasel/hasel_sysid: identification", {})
            return heard.get("publishers of /hasel/bending/simulated") == "1"

        listener.until(connected, 60.0, stack.check)
        yield stack


def replay(stack: Processes, listener: Listener, *arguments: str) -> None:
    """Replay the run and wait until every frame was compared."""
    listener.forget()
    expected = ("--expect", "hasel_simulator", "hasel_sysid", "listener")
    stack.start("hasel_bringup", "replay", str(RUN), *expected, *arguments)
    frames = len(RUN.read_text().splitlines()) - 1
    heard = (listener.states, listener.measured, listener.simulated, listener.errors)
    listener.until(lambda: min(map(len, heard)) == frames, 60.0, lambda: None)  # topics come in any order
    assert stack.finish("replay", 30.0) == 0


def compared(model_file: Path) -> float:
    """Mean |Δ sin θ| of the model on the file, without any node."""
    experiments = load_experiments([RUN])
    return Problem(experiments, SerialExecutor()).evaluate(load_model(model_file)).mean_absolute_error


@pytest.mark.timeout(180)
def test_three_processes_agree_with_compare(stack, listener, model_file):
    """Every state is answered at its stamp, and the error published at the end is that of the comparison."""
    replay(stack, listener, "--rate", "1")
    stamps = [stamp_ns(state) for state in listener.states]
    assert [stamp_ns(angle) for angle in listener.simulated] == stamps
    assert [stamp_ns(angle) for angle in listener.measured] == stamps
    assert [stamp_ns(error) for error in listener.errors] == stamps
    expected = compared(model_file)
    heard = (listener.states, listener.measured, listener.simulated, listener.errors)
    frames = [{message.header.frame_id for message in messages} for messages in heard]
    assert frames == [{f"hasel/{name}"} for name in ("supply", "camera", "swimmer", "swimmer")]
    assert listener.errors[-1].mean_absolute_error == pytest.approx(expected, abs=TOLERANCE)
    assert expected > 0.004

    replay(stack, listener, "--rate", "max")
    assert [stamp_ns(angle) for angle in listener.simulated] == stamps
    assert listener.errors[-1].mean_absolute_error == pytest.approx(expected, abs=TOLERANCE)

    answer = listener.call(FitModel, "/hasel/fit", 100.0, stack.check)
    assert answer.success, answer.message
    assert answer.fit.header.frame_id == "hasel/swimmer"
    assert listener.call(LoadModel, "/hasel/load_model", 20.0, stack.check, model=answer.fit.model).success
    replay(stack, listener, "--rate", "max")
    assert listener.errors[-1].mean_absolute_error == pytest.approx(
        answer.fit.mean_absolute_error, abs=TOLERANCE
    )
    assert answer.fit.mean_absolute_error < 0.8 * expected
    assert [stack.stop(name) for name in ("simulator", "sysid")] == [0, 0]
