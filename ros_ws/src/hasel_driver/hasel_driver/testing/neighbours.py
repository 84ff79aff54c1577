# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Kinds of other nodes that a driver meets: a second driver of its name, strangers; judged by the supply's voltages."""

import socket
import time
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass, field

from hasel_interfaces.msg import Actuation, SupplyState
from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import Trigger

from hasel_driver.protocol.faults import FaultCode
from hasel_driver.testing.kinds import WATCHED_S, WITHIN_S, Trial
from hasel_driver.testing.rig import VIRTUAL_SUPPLY, Rig
from hasel_driver.testing.ros_client import LATCHED, DriverProcess, RosClient, another_node

DRIVEN_V = (1500.0, 0.0)
STRANGE_V = (4000.0, 0.0)
COMES_WITHIN_S = 25.0
ASKED = 3  # times, as one of two drivers answers
PERIOD_S = 0.005
ANNOUNCED_EVERY_S = 0.5
"""A node is announced so often over loopback: the user may hear of it so much sooner than the driver."""
ANSWERS = ("arm", "emergency_stop", "disarm")
DRIVER, STRANGER = f"/hasel/hasel_driver on {socket.gethostname()}", "/stranger"


@dataclass(frozen=True)
class Scene:
    """A driver on its supply, its user, further supplies, and what is taken away at the end."""

    rig: Rig
    user: RosClient
    leaving: ExitStack
    others: list[Rig] = field(default_factory=list)


@dataclass(frozen=True)
class Neighbour:
    """Who comes to a driver, and what must not become of it.

    comes: returns what is to be done over and over while it is watched; told: how the driver's fault names the
    other, within half a second of when the driver can see it, or None where it is no fault and only must not be obeyed;
    refused: services that must not answer success.
    """

    name: str
    comes: Callable[[Scene], Callable[[], None]]
    told: str | None
    refused: tuple[str, ...] = ()
    driven: bool = True
    welded: bool = False  # the contact of the driver's own supply


def _nothing() -> None:
    pass


def _second_driver(scene: Scene) -> Callable[[], None]:
    rig = Rig(VIRTUAL_SUPPLY)
    scene.others.append(rig)
    scene.leaving.callback(rig.close)
    scene.leaving.callback(DriverProcess(scene.user, rig.port).close)
    return _nothing


def _stranger(scene: Scene) -> Node:
    return scene.leaving.enter_context(another_node("stranger"))


def _state(scene: Scene) -> Callable[[], None]:
    _stranger(scene).create_publisher(SupplyState, "/hasel/state", 10)
    return _nothing


def _service(scene: Scene) -> Callable[[], None]:
    _stranger(scene).create_service(Trigger, "/hasel/emergency_stop", lambda _, response: response)
    return _nothing


def _commands(scene: Scene) -> Callable[[], None]:
    publisher = _stranger(scene).create_publisher(Actuation, "/hasel/command", 10)
    publisher.publish(Actuation(voltage=[0.0, 0.0]))
    return lambda: publisher.publish(Actuation(voltage=list(STRANGE_V)))


def _releases(scene: Scene) -> Callable[[], None]:
    scene.user.emergency_stop_topic(True)
    scene.leaving.callback(scene.user.drop_emergency_stop_topic)
    scene.leaving.callback(scene.user.emergency_stop_topic, False)
    stranger = _stranger(scene).create_publisher(Bool, "/hasel/emergency_stop", LATCHED)
    scene.user.wait(lambda: bool(scene.user.state.emergency_stop_holders))
    return lambda: stranger.publish(Bool(data=False))


NEIGHBOURS: tuple[Neighbour, ...] = (
    Neighbour("two drivers of one name", _second_driver, DRIVER, ANSWERS),
    Neighbour("two drivers of one name, a contact welded", _second_driver, DRIVER, ANSWERS, welded=True),
    Neighbour("a stranger publishes the state", _state, STRANGER, ANSWERS),
    Neighbour("a stranger answers emergency stops", _service, STRANGER, ("arm", "disarm")),
    Neighbour("a stranger commands beside who may", _commands, None),
    Neighbour("a stranger commands what is not armed", _commands, None, driven=False),
    Neighbour("a stranger takes back another's stop", _releases, None, ("clear_fault", "arm")),
)


def meet(user: RosClient, kind: Neighbour, rig: Rig) -> Trial:
    """Start a driver, let the neighbour come, and judge what is said and done by the supplies' own output."""
    trial = Trial()
    user.wait(lambda: not drivers(user), COMES_WITHIN_S)
    with ExitStack() as leaving:
        leaving.callback(rig.say, "recover")
        driver = DriverProcess(user, rig.port)
        leaving.callback(driver.close)
        scene = Scene(rig, user, leaving)
        user.wait(lambda: bool(user.states), COMES_WITHIN_S)
        driver.to_standby()
        if kind.driven:
            driver.arm()
            leaving.enter_context(user.commanding(DRIVEN_V))
            user.wait(lambda: user.state.measured_voltage[0] > DRIVEN_V[0] / 2)
        if kind.welded:
            rig.say("weld")
        user.heard.clear()
        again = kind.comes(scene)
        if kind.told:
            user.wait(lambda: drivers(user) > 1, COMES_WITHIN_S)
        _watch(scene, trial, kind, again)
        _judge(scene, trial, kind)
    return trial


def drivers(user: RosClient) -> int:
    """How many there seem to be."""
    return max(user.node.count_publishers("/hasel/state"), user.node.count_services("/hasel/emergency_stop"))


def _watch(scene: Scene, trial: Trial, kind: Neighbour, again: Callable[[], None]) -> None:
    """The true voltages, from when the other can be seen until long after it should have been found."""
    seen_s = time.monotonic()
    most_v = 1.1 * DRIVEN_V[0] if kind.driven else 0.0
    while (now_s := time.monotonic()) < seen_s + WATCHED_S + ANNOUNCED_EVERY_S:
        again()
        volts = abs(scene.rig.ask("output")[0])
        if volts > most_v or any(other.live for other in scene.others):
            trial.wrong.append(f"{volts:.0f} V, {DRIVEN_V[0] if kind.driven else 0:g} V were commanded")
        if kind.told and trial.found_s is None and (kind.welded or not scene.rig.live):
            trial.found_s = now_s - seen_s if any(map(_faulted, scene.user.heard.copy())) else None
        time.sleep(PERIOD_S)


def _faulted(state: SupplyState) -> bool:
    return state.fault_code == FaultCode.TWO_DRIVERS


def _judge(scene: Scene, trial: Trial, kind: Neighbour) -> None:
    user = scene.user
    if kind.told:
        texts = {state.fault_text for state in user.heard.copy() if _faulted(state)}
        if not any(kind.told in text for text in texts):
            trial.wrong.append(f"{texts or 'nothing'} was told, {kind.told} expected")
        if trial.found_s is None or trial.found_s > WITHIN_S + ANNOUNCED_EVERY_S:
            trial.wrong.append(f"it was grounded after {trial.found_s} s")
    for service in kind.refused * ASKED:
        answer = user.trigger(service)
        if answer.success:
            trial.wrong.append(f"{service} was answered by {answer.message}")
    trial.wrong += user.false_proofs(scene.rig)
