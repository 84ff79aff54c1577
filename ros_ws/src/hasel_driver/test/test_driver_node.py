# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The node: states, commands, services, lifecycle; on a supply that knows the truth about its output."""

import itertools
import math
import threading
import time
from functools import partial

import pytest
from hasel_driver.protocol.faults import FaultCode

STANDBY, ARMED, ACTIVE, FAULT = range(4)
GROUNDED_WITHIN_S = 0.5
PATIENCE_S = 10.0
CONFIGURE, CLEANUP, ACTIVATE, DEACTIVATE, UNKNOWN = 1, 2, 3, 4, 77
DISCHARGED_WITHIN_S = 0.02  # of the contact that the board reports: 0.5 nF over 2 MΩ, 10 kV to 50 V in 5.3 ms


def test_nothing_is_live_before_arming(driver, shared_rig, ros):
    """Configured and active, the node is in STANDBY; commands are not obeyed until the service arm is called."""
    ros.await_mode(STANDBY, 10.0)
    for _ in range(20):
        ros.command((3000.0, 3000.0))
        time.sleep(0.02)
    assert shared_rig.changes == []
    driver.arm()
    assert ros.await_mode(ARMED).commanded_voltage.tolist() == [0.0, 0.0]


@pytest.mark.rounds(3, 50)
def test_commands_are_clipped_and_what_was_sent_is_reported(driver, shared_rig, ros, rounds):
    """Above the limit, the limit is on the wire, in the state and on the output."""
    shared_rig.say("trace")
    driver.arm()
    for index in range(rounds):
        sign = (-1) ** index
        sent = [sign * 6000.0, -sign * 1000.0]

        def follows(sent=sent) -> bool:
            reached = ros.state.measured_voltage == pytest.approx(sent, abs=100)
            return reached and ros.state.commanded_voltage.tolist() == sent

        ros.drive(follows, (sign * 10.0 ** (4 + index % 9), sent[1]))
    assert max(abs(voltage) for _, *voltages in shared_rig.wire for voltage in voltages) == 6000
    assert max(shared_rig.ask("output")[4:]) < 6100


@pytest.mark.rounds(1, 25)
def test_commands_expire(driver, shared_rig, ros, rounds):
    """200 ms after the last command the voltage is zero, and the supply still armed."""
    driver.arm()
    for _ in range(rounds):
        ros.drive(lambda: shared_rig.live)
        last_s = time.monotonic()
        assert 0.15 < shared_rig.await_live(False) - last_s < GROUNDED_WITHIN_S
        assert ros.await_mode(ARMED).commanded_voltage.tolist() == [0.0, 0.0]


def test_old_and_future_commands_are_ignored(driver, shared_rig, ros):
    """A stamp more than 200 ms off is not obeyed, and the log says that the clocks may differ."""
    driver.arm()
    shared_rig.changes.clear()
    for _ in range(15):
        ros.command((3000.0, 3000.0), age_s=0.25)
        ros.command((3000.0, 3000.0), age_s=-5.0)
        time.sleep(0.02)
    assert shared_rig.changes == []
    assert ros.await_mode(ARMED)
    ros.wait(lambda: any("Synchronise the clocks" in line for line in driver.log))


@pytest.mark.rounds(1, 25)
@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_not_a_number_is_a_fault(provoke, ros, bad, rounds):
    """NaN means that the controller is broken: grounded and latched."""
    for _ in range(rounds):
        provoke(lambda: ros.command((1000.0, bad)), FaultCode.INVALID_COMMAND)
        assert ros.trigger("clear_fault").success


@pytest.mark.parametrize("voltages", [(), (1000.0,), (1000.0, 0.0, 0.0)])
def test_a_command_for_another_number_of_muscles_is_a_fault(provoke, ros, voltages):
    """As a value that is no number: grounded and latched, with the reason."""
    provoke(lambda: ros.command(voltages), FaultCode.INVALID_COMMAND)
    assert f"{len(voltages)} voltages were commanded" in ros.state.fault_text
    assert ros.trigger("clear_fault").success


def test_deactivating_disarms_and_activating_does_not_arm(driver, shared_rig, ros):
    """The lifecycle leads away from high voltage, never to it."""
    driver.arm()
    ros.drive(lambda: shared_rig.live)
    ros.transition(DEACTIVATE)
    answered_s = time.monotonic()
    assert shared_rig.await_live(False) < answered_s + DISCHARGED_WITHIN_S
    assert "not active" in ros.trigger("arm").message
    ros.transition(ACTIVATE)
    ros.await_mode(STANDBY)
    ros.command((3000.0, 0.0))
    ros.transition(DEACTIVATE)
    ros.transition(CLEANUP)
    assert "port is closed" in ros.trigger("arm").message
    ros.transition(CONFIGURE)
    ros.await_mode(STANDBY)
    assert not shared_rig.live
    ros.transition(ACTIVATE)


@pytest.mark.rounds(3, 40)
def test_illegal_transitions(driver, provoke, ros, rounds):
    """An illegal transition, which in rclpy ends spinning, grounds the output, is said, and is survived."""
    before = _told_illegal(driver)
    for _, identifier in zip(range(rounds), itertools.cycle((CONFIGURE, CLEANUP, ACTIVATE, UNKNOWN))):
        provoke(partial(ros.illegal_transition, identifier), FaultCode.ILLEGAL_TRANSITION)
        assert "and has proven it" in ros.state.fault_text
        assert ros.trigger("clear_fault").success
    told = _told_illegal(driver)
    assert told - before >= rounds
    ros.illegal_transition(CLEANUP)
    ros.wait(lambda: _told_illegal(driver) > told)
    ros.await_mode(STANDBY)
    assert driver.process.poll() is None


def _told_illegal(driver) -> int:
    return sum("Illegal lifecycle transition" in line for line in list(driver.log))


def test_a_second_commander_is_refused_by_the_holders_name(driver, shared_rig, ros):
    """Arming gave the claim to one publisher: another's commands are not obeyed, and both names are told."""
    from hasel_driver.testing.ros_client import RosClient

    driver.arm()
    shared_rig.say("trace")
    rival = RosClient("rival")
    try:
        with ros.commanding((1000.0, -500.0)):
            ros.wait(lambda: shared_rig.live)
            with rival.commanding((4000.0, 4000.0)):
                ros.wait(lambda: any("/rival are refused: /user holds" in line for line in list(driver.log)))
                time.sleep(0.3)
            assert (ros.state.mode, ros.state.commander) == (ACTIVE, "/user")
        assert not [upper for _, upper, _ in shared_rig.wire if upper == 4000]
        ros.trigger("disarm")
        answer = ros.trigger("arm")
        assert (answer.success, "More than one node publishes" in answer.message) == (False, True)
    finally:
        rival.close()


def test_a_controller_that_comes_back_has_its_claim_again(driver, shared_rig, ros):
    """Killed and started anew it is obeyed at once, from 0 V on, though the middleware still knows the first."""
    from hasel_driver.testing.ros_client import RosClient

    with ros.silent():
        first = RosClient("controller")
        first.wait(lambda: first.commands.get_subscription_count() > 0)
        driver.arm()
        with first.commanding():
            ros.wait(lambda: shared_rig.live)
        second = RosClient("controller")
        try:
            shared_rig.await_live(False)
            second.wait(lambda: second.commands.get_subscription_count() > 0)
            second.command((3000.0, 0.0))
            time.sleep(0.1)
            assert not shared_rig.live
            with second.commanding():
                ros.wait(lambda: shared_rig.live)
        finally:
            first.close()
            second.close()


def test_live_output_begins_with_a_zero_command(driver, shared_rig, ros):
    """Arming while a voltage is being published leaves the output at 0 V until 0 V was commanded."""
    ros.await_mode(STANDBY, 10.0)
    ended = threading.Event()

    def insist() -> None:
        while not ended.wait(0.02):
            ros.command((6000.0, 0.0))

    thread = threading.Thread(target=insist, daemon=True)
    thread.start()
    try:
        ros.wait(lambda: ros.trigger("arm").success)
        ros.await_mode(ARMED)
        shared_rig.changes.clear()
        time.sleep(0.3)
        assert shared_rig.changes == []
        ros.command((0.0, 0.0))
        ros.wait(lambda: shared_rig.live)
    finally:
        ended.set()
        thread.join()


def look_on() -> None:
    """Join with a context of its own until it has heard `/hasel/state`, as `ros2 topic echo --once` does."""
    import rclpy
    from hasel_common.managed_node import node_alone
    from hasel_interfaces.msg import SupplyState
    from rclpy.executors import SingleThreadedExecutor

    heard: list[SupplyState] = []
    node = node_alone("onlooker")
    node.create_subscription(SupplyState, "/hasel/state", heard.append, 10)
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    end_s = time.monotonic() + PATIENCE_S
    while not heard and time.monotonic() < end_s:
        executor.spin_once(timeout_sec=0.1)
    executor.shutdown()
    node.destroy_node()
    rclpy.try_shutdown(context=node.context)
    assert heard, f"nothing was heard within {PATIENCE_S} s"


@pytest.mark.rounds(2, 40)
def test_nodes_that_come_and_go_do_not_hold_it_up(driver, shared_rig, ros, rounds):
    """Discovery, which can make the middleware wait, neither stops the heartbeat nor the commands."""
    driver.arm()
    with ros.commanding():
        ros.wait(lambda: shared_rig.live)
        for _ in range(rounds):
            look_on()
        assert (ros.state.mode, shared_rig.live) == (ACTIVE, True), ros.state.fault_text


def test_parameters_are_checked(driver, ros):
    """A value out of range, or a change while the port is open, is refused with its reason."""
    from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
    from rcl_interfaces.srv import DescribeParameters, SetParameters

    def change(name: str, value: float) -> str:
        number = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=value)
        request = SetParameters.Request(parameters=[Parameter(name=name, value=number)])
        (result,) = ros.request(SetParameters, "/hasel/hasel_driver/set_parameters", request).results
        return "accepted" if result.successful else result.reason

    ros.await_mode(STANDBY, 10.0)
    assert "maximum_voltage" in change("maximum_voltage", 20_000.0)
    assert change("maximum_voltage", 20_000.0) != "accepted"
    assert "in use" in change("slew_rate", 100e3)
    assert change("maximum_voltage", 5000.0) == "accepted"
    assert "only be lowered" in change("maximum_voltage", 6000.0)
    ros.wait(lambda: ros.state.maximum_voltage == 5000.0)
    assert ros.state.slew_rate == 250_000.0
    request = DescribeParameters.Request(names=["maximum_voltage"])
    (described,) = ros.request(
        DescribeParameters, "/hasel/hasel_driver/describe_parameters", request
    ).descriptors
    assert described.floating_point_range[0].to_value == 9800.0
    assert "[V]" in described.description


def test_diagnostics_tell_state_and_output(driver, ros):
    """/diagnostics carries mode, output and device."""
    from diagnostic_msgs.msg import DiagnosticArray

    received = []
    subscription = ros.node.create_subscription(DiagnosticArray, "/diagnostics", received.append, 10)
    try:
        ros.wait(lambda: received and received[-1].status[0].level == b"\x00", 10.0)
    finally:
        ros.node.destroy_subscription(subscription)
    entry = received[-1].status[0]
    values = {pair.key: pair.value for pair in entry.values}
    assert (values["mode"], values["output"] in ("grounded", "commanded")) == ("STANDBY", True)
    assert values["device"].startswith("hasel-supply")
