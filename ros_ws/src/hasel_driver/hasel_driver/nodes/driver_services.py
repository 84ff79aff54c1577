# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What the driver tells: the supply's state as messages, and the services that arm, stop and clear.

Each service answers for what the supply reports, and only as the only driver.
"""

import math
import time
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from functools import partial

from builtin_interfaces.msg import Time
from hasel_common.diagnostics import Level
from hasel_interfaces.msg import SupplyState
from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from std_srvs.srv import Trigger

from hasel_driver.nodes.other_drivers import Claim
from hasel_driver.nodes.surroundings import HostSurroundings
from hasel_driver.protocol.faults import DriverError, Fault, FaultCode, RefusedError
from hasel_driver.protocol.limits import MUSCLE_NAMES, Limits
from hasel_driver.protocol.status import Ground, Mode, SupplyStatus
from hasel_driver.safety.supply_link import ENDED, Snapshot, SupplyLink

OUTPUT_WORDS = {
    "grounded": "The supply reports its output grounded, and has proven it; stored charge needs its bleeder's time.",
    "commanded": "The output is commanded to ground, not proven: treat it as live.",
    "live": "The supply does not report its output grounded: treat it as live.",
    "unknown": "Nothing proves the output grounded: treat it as live.",
}
PROOF_TIMEOUT_S = 0.4
ARMING_TIMEOUT_S = 1.0  # with the test pulse
SERVICES = ("arm", "disarm", "emergency_stop", "release_emergency_stop", "clear_fault")


def to_time(monotonic_s: float) -> Time:
    """The system time at which the monotonic clock showed `monotonic_s`."""
    nanoseconds = time.time_ns() + int((monotonic_s - time.monotonic()) * 1e9)
    return Time(sec=nanoseconds // 1_000_000_000, nanosec=nanoseconds % 1_000_000_000)


def to_supply_state(
    status: SupplyStatus,
    limits: Limits | None = None,
    holders: Sequence[str] = (),
    frame_id: str = "",
    commander: str = "",
) -> SupplyState:
    """`/hasel/state`; in FAULT its text also tells whether the output is proven grounded, else why it disarmed."""
    message = SupplyState()
    message.header.stamp, message.header.frame_id = to_time(status.time_s), frame_id
    message.muscle = list(MUSCLE_NAMES)
    message.commanded_voltage = list(status.commanded_v)
    message.measured_voltage = list(status.measured_v)
    message.current = list(status.current_a)
    message.mode = int(status.mode)
    message.fault_code = int(status.fault.code) if status.fault else 0
    message.grounded = status.ground is Ground.PROVEN
    message.ground = int(status.ground or Ground.NOT)
    message.interlock = _interlock(status.interlock_closed)
    message.emergency_stop_holders = list(holders)
    message.maximum_voltage = limits.maximum_voltage_v if limits else math.nan
    message.slew_rate = limits.slew_v_per_ms * 1e3 if limits else math.nan
    message.trip_current = limits.trip_current_a if limits else math.nan
    message.heartbeat_timeout = limits.heartbeat_s if limits else math.nan
    message.commander = commander
    if status.mode is Mode.FAULT:
        words = str(status.fault) if status.fault else "the supply is not connected, or does not report"
        message.fault_text = f"{sentence(words)} {OUTPUT_WORDS[status.output]}"
    elif status.note:
        message.fault_text = sentence(status.note)
    return message


def sentence(words: str) -> str:
    """With a capital and a full stop."""
    return f"{words[:1].upper()}{words[1:]}."


def _interlock(closed: tuple[bool, bool] | None) -> list[int]:
    if closed is None:
        return [SupplyState.INTERLOCK_UNKNOWN] * 2
    return [SupplyState.INTERLOCK_CLOSED if each else SupplyState.INTERLOCK_OPEN for each in closed]


def supply_health(status: SupplyStatus | None) -> tuple[Level, str, dict[str, object]]:
    """What `/diagnostics` says of a supply: level, sentence, values; no status means that none is configured."""
    if status is None:
        return Level.WARN, "not configured: the port is closed", {}
    level = Level.WARN if status.silent_s else Level.OK
    level = Level.ERROR if status.mode is Mode.FAULT else level
    words = str(status) + (f", no report for {status.silent_s:.1f} s" if status.silent_s else "")
    return level, words, {"mode": status.mode.name, "output": status.output}


class DriverServices:
    """`link()` is the open supply or None; `check_arming()` raises RefusedError.

    While `unchanging` is held, the node neither deactivates nor closes the port.
    """

    def __init__(
        self,
        node: Node,
        group: CallbackGroup,
        link: Callable[[], SupplyLink | None],
        unchanging: AbstractContextManager[object],
        check_arming: Callable[[], None],
        surroundings: HostSurroundings,
        claim: Claim,
    ) -> None:
        self._node, self._link, self._unchanging = node, link, unchanging
        self._check_arming, self._surroundings, self._claim = check_arming, surroundings, claim
        for name in SERVICES:
            handler = partial(self._serve, getattr(self, name))
            node.create_service(Trigger, name, handler, callback_group=group)

    def _serve(
        self, action: Callable[[], str], _: Trigger.Request, response: Trigger.Response
    ) -> Trigger.Response:
        try:
            response.message = action()
            response.success = True
        except DriverError as error:
            response.message = str(error)
            self._node.get_logger().warning(response.message)
        return response

    def arm(self) -> str:
        """STANDBY to ARMED."""
        link = self._require_link()
        with self._unchanging:
            self._check_arming()
            link.ask("arm")
        self._claim.hand_out(self._surroundings.inputs.commanders())
        decided = link.wait_for(lambda now: now.status.mode is Mode.ARMED or not now.armed, ARMING_TIMEOUT_S)
        if not decided or not link.now.armed:
            link.tell("disarm")
            raise RefusedError(f"The supply did not arm: {link.now.refusal or link.now.status}.")
        self._node.get_logger().warning("Armed: high voltage may be on the output from now on.")
        return "Armed, 0 V."

    def disarm(self) -> str:
        """To STANDBY, from everywhere but FAULT."""
        link = self._require_link()
        link.ask("disarm")
        return self._prove_grounded(link, "Disarmed")

    def emergency_stop(self) -> str:
        """To FAULT, from everywhere; refused, though it is done, unless the output is proven grounded."""
        link = self._require_link()
        link.ask("fail", Fault(FaultCode.EMERGENCY_STOP, "by service"))
        answer = self._prove_grounded(link, "Stopped", PROOF_TIMEOUT_S)
        if link.now.status.output != "grounded":
            raise RefusedError(answer)
        return answer

    def clear_fault(self) -> str:
        """FAULT to STANDBY."""
        link = self._require_link()
        self._surroundings.check_clearing()
        link.wait_for(lambda now: now.status.quiet is not False, PROOF_TIMEOUT_S)
        link.ask("clear_fault")
        return "Cleared: STANDBY, disarmed."

    def release_emergency_stop(self) -> str:
        """Take back what the topic's publishers hold; the fault stays until it is cleared."""
        names = self._surroundings.inputs.holders.release()
        if not names:
            return "Nobody held the emergency stop."
        return f"Released what {', '.join(names)} held; now clear the fault."

    def _prove_grounded(self, link: SupplyLink, done: str, for_proof_s: float = 0.0) -> str:
        """The answer once the output is commanded to ground, or so much later, if the proof does not come before."""

        def off(now: Snapshot) -> bool:
            return now.status.quiet is True and not now.status.mode.may_be_live

        if link.wait_for(off, PROOF_TIMEOUT_S):
            if for_proof_s:
                link.wait_for(lambda now: now.status.output == "grounded", for_proof_s)
            return self._for_all(f"{done}. {OUTPUT_WORDS[link.now.status.output]}")
        if not link.now.capabilities.proves_grounded and link.now.connected:
            return self._for_all(
                f"{done}: the supply was switched off, but this kind cannot prove its output grounded."
            )
        unproven = Fault(FaultCode.GROUND_NOT_PROVEN, f"{done.lower()} {PROOF_TIMEOUT_S} s ago")
        link.ask("fail", unproven)
        raise RefusedError(f"{done}, but NOT proven: {link.now.status}. Treat the output as live.")

    def _for_all(self, answer: str) -> str:
        """The answer, where this driver is the only one; else it would stand for supplies that it does not know."""
        rivals = self._surroundings.inputs.rivals.found()
        if rivals:
            raise RefusedError(
                f"{answer} That is true of this supply only: {1 + len(rivals)} drivers answer to this name,"
                f" also {', '.join(rivals)}. Treat every output as live, stop each, and end all but one."
            )
        return answer

    def _require_link(self) -> SupplyLink:
        link = self._link()
        if link is None:
            raise RefusedError("The port is closed: configure the node (lifecycle) first.")
        if not link.is_alive():
            raise RefusedError(ENDED)
        return link
