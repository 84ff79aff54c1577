# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Two rigs side by side, and names and quality of service changed from outside."""

import numpy as np
import pytest
from hasel_bringup.processes import Processes
from hasel_common.endpoints import Role
from hasel_interfaces.msg import Actuation, BendingAngle, SupplyState
from rcl_interfaces.srv import GetParameters
from std_srvs.srv import Trigger

HELD_UP = {
    SupplyState.FAULT_NONE,
    SupplyState.FAULT_NO_TELEMETRY,
    SupplyState.FAULT_NO_REPLY,
    SupplyState.FAULT_HOST_STALLED,
}
"""Faults of a rig whose machine is too busy for its virtual board."""


@pytest.mark.timeout(300)
def test_two_rigs_do_not_hear_each_other(tmp_path, environment, listener):
    """Each has its supply, camera and frames; arming and driving one leaves the other grounded and straight."""
    states = {name: [] for name in ("rig1", "rig2")}
    angles = {name: [] for name in ("rig1", "rig2")}
    for name in states:
        every = Role.EVERY_SAMPLE.value
        listener.node.create_subscription(SupplyState, f"/{name}/state", states[name].append, every)
        listener.node.create_subscription(
            BendingAngle, f"/{name}/bending/measured", angles[name].append, every
        )
    with Processes(tmp_path / "1", environment) as first, Processes(tmp_path / "2", environment) as second:
        for name, processes in (("rig1", first), ("rig2", second)):
            processes.start("hasel_bringup", "virtual_rig", "--ros-args", "-r", f"__ns:=/{name}")

        def check() -> None:
            first.check()
            second.check()

        listener.until(lambda: min(len(angles[name]) for name in angles) > 200, 100.0, check)
        listener.arm("/rig2", states["rig2"], check)
        command = listener.node.create_publisher(Actuation, "/rig2/command", 1)

        def drive() -> None:
            check()
            if states["rig2"][-1].mode == SupplyState.FAULT:
                listener.arm("/rig2", states["rig2"], check)
            if states["rig2"][-1].mode == SupplyState.ARMED:
                command.publish(Actuation(voltage=[0.0, 0.0]))  # with which every controller begins
            command.publish(Actuation(voltage=[4000.0, 0.0]))

        listener.until(lambda: angles["rig2"][-1].sin_theta > 0.1, 60.0, drive)
        assert not {state.mode for state in states["rig1"]} & {SupplyState.ARMED, SupplyState.ACTIVE}
        assert {state.fault_code for state in states["rig1"]} <= HELD_UP
        assert not any(abs(voltage) > 0 for state in states["rig1"] for voltage in state.commanded_voltage)
        assert np.abs([angle.sin_theta for angle in angles["rig1"]]).max() < 0.03
        for name in states:
            assert states[name][-1].header.frame_id == f"{name}/supply"
            assert angles[name][-1].header.frame_id == f"{name}/camera"
        if states["rig1"][-1].mode == SupplyState.FAULT:
            listener.call(Trigger, "/rig1/clear_fault", 20.0, check)
        answer = listener.call(Trigger, "/rig1/emergency_stop", 20.0, check)
        assert answer.message.startswith("Stopped"), answer.message  # never charged, its ground is not proven
        listener.until(lambda: states["rig1"][-1].mode == SupplyState.FAULT, 20.0, drive)
        listener.until(lambda: states["rig2"][-1].mode == SupplyState.ACTIVE, 20.0, drive)
        assert not listener.states  # nobody speaks in the default namespace
        supplies = {f"{name}/hasel_driver: supply" for name in states}
        listener.until(lambda: supplies <= listener.diagnostics.keys(), 60.0, check)
        assert supplies == {key for key in listener.diagnostics if key.endswith(": supply")}
        assert first.stop("virtual_rig") == second.stop("virtual_rig") == 0


@pytest.mark.timeout(200)
def test_a_topic_is_remapped_and_its_quality_of_service_overridden(tmp_path, environment, listener):
    """`-r state:=…` for one node, `-p qos_overrides.…` for one publisher; the override is a read-only parameter."""
    with Processes(tmp_path, environment) as processes:
        override = "qos_overrides./hasel/bending/simulated.publisher."
        processes.start(
            "hasel_sim",
            "simulator",
            "--ros-args",
            *("-r", "state:=supply/state"),
            *("-p", f"{override}reliability:=best_effort"),
            *("-p", f"{override}history:=keep_last"),
            *("-p", f"{override}depth:=7"),
        )
        node = "/hasel/hasel_simulator"
        answer = listener.call(
            GetParameters, f"{node}/get_parameters", 60.0, processes.check, names=[f"{override}depth"]
        )
        assert answer.values[0].integer_value == 7
        hear = listener.node.get_subscriptions_info_by_topic
        listener.until(lambda: hear("/hasel/supply/state"), 30.0, processes.check)
        assert not [each for each in hear("/hasel/state") if each.node_name == "hasel_simulator"]
        (offered,) = listener.node.get_publishers_info_by_topic("/hasel/bending/simulated")
        assert offered.qos_profile.reliability.name == "BEST_EFFORT"
