# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Supply, driver, body and camera without hardware, started as a user does."""

import numpy as np
import pytest
from hasel_bringup.processes import Processes
from hasel_interfaces.msg import Actuation, SupplyState

from tests.nodes.listener import stamp_ns


@pytest.mark.timeout(150)
def test_an_armed_virtual_rig_bends_what_the_camera_sees(tmp_path, environment, listener):
    """The command goes over the serial protocol and back as a state; the measured angle follows it, at 120 frames/s."""
    with Processes(tmp_path, environment) as processes:
        hidden = "hidden:=[quadratic_drag.coefficient=0.25]"
        processes.start("hasel_bringup", "virtual_rig", "--ros-args", "-p", hidden)
        # two seconds: longer than the driver waits for a latched emergency stop
        listener.until(lambda: min(len(listener.measured), len(listener.states)) > 200, 60.0, processes.check)
        assert {state.header.frame_id for state in listener.states} == {"hasel/supply"}
        assert {angle.header.frame_id for angle in listener.measured} == {"hasel/camera"}
        rest = np.array([angle.sin_theta for angle in listener.measured])
        assert 1e-3 < rest.std() < 5e-3
        assert {state.mode for state in listener.states} == {SupplyState.STANDBY}

        listener.arm("/hasel", listener.states, processes.check)
        command = listener.node.create_publisher(Actuation, "/hasel/command", 1)

        def drive() -> None:
            processes.check()
            if listener.states and listener.states[-1].mode == SupplyState.FAULT:
                listener.arm("/hasel", listener.states, processes.check)
            if listener.states and listener.states[-1].mode == SupplyState.ARMED:
                command.publish(Actuation(voltage=[0.0, 0.0]))  # with which every controller begins
            command.publish(Actuation(voltage=[4000.0, 0.0]))

        listener.forget()
        listener.until(lambda: listener.measured and listener.measured[-1].sin_theta > 0.1, 30.0, drive)
        assert np.nanmax([state.commanded_voltage[0] for state in listener.states]) == pytest.approx(4000.0)
        frames = np.array([stamp_ns(angle) for angle in listener.measured])
        assert len(frames) > 5
        assert np.median(np.diff(frames)) == pytest.approx(1e9 / 120, rel=1e-6)
        assert processes.stop("virtual_rig") == 0
