# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The simulator's node at the camera's rate."""

import os
import time

import numpy as np
import pytest
from hasel_bringup.processes import Processes
from hasel_interfaces.msg import SupplyState
from hasel_sim.model import load_model, save_model

from tests.nodes.listener import EVERY_MESSAGE, stamp_ns

_RATE, _HALF_PERIOD = 120, 30
_FRAMES = 25 * _RATE


@pytest.mark.slow
@pytest.mark.timeout(120)
def test_the_node_is_never_behind_on_one_core(tmp_path, environment, listener):
    """120 states a second, for longer than the history is: each is answered before twelve more have come."""
    model = load_model("swimmer").with_levels(np.array([5500.0])).with_values({"amplitude_5500": 0.06})
    save_model(model, tmp_path / "model.yaml")
    states = listener.node.create_publisher(SupplyState, "/hasel/state", EVERY_MESSAGE)
    with Processes(tmp_path, environment) as processes:
        processes.start("hasel_sim", "simulator", "--ros-args", "-p", f"model:={tmp_path / 'model.yaml'}")
        listener.until(lambda: states.get_subscription_count() == 2, 60.0, processes.check)
        os.sched_setaffinity(processes.process_id("simulator"), {max(os.sched_getaffinity(0))})
        listener.until(
            lambda: "hasel/hasel_simulator: simulation" in listener.diagnostics, 20.0, processes.check
        )
        worst, factors, begun = [], [], time.monotonic()

        def pace() -> None:
            processes.check()
            values = listener.diagnostics["hasel/hasel_simulator: simulation"]
            worst.append(float(values["worst lag [ms]"]))
            factors.append(float(values["real-time factor"]))

        for frame in range(_FRAMES):
            upper = (frame // _HALF_PERIOD) % 2 == 0
            state = SupplyState(commanded_voltage=[5500.0 * upper, 5500.0 * (not upper)])
            state.header.stamp.sec, rest = divmod(frame, _RATE)
            state.header.stamp.nanosec = round(rest / _RATE * 1e9)
            states.publish(state)
            due = begun + (frame + 1) / _RATE
            listener.until(lambda due=due: time.monotonic() >= due, 10.0, pace)
        listener.until(
            lambda: len(listener.simulated) == len(listener.states) == _FRAMES, 2.0, processes.check
        )
    assert [stamp_ns(angle) for angle in listener.simulated] == [stamp_ns(state) for state in listener.states]
    assert np.nanmax(worst) < 100.0
    print(f"real-time factor {np.nanmedian(factors):.1f}, worst lag {np.nanmax(worst):.1f} ms")
