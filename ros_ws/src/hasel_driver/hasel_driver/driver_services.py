"""The services that arm, stop and clear: each answers for what the supply reports, and only as the only driver."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from functools import partial

from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from std_srvs.srv import Trigger

from hasel_driver.errors import DriverError, RefusedError
from hasel_driver.faults import Fault, FaultCode
from hasel_driver.messages import OUTPUT_WORDS
from hasel_driver.mode import Mode
from hasel_driver.safety_messages import Snapshot
from hasel_driver.supply_link import ENDED, SupplyLink

PROOF_TIMEOUT_S = 0.4
ARMING_TIMEOUT_S = 1.0  # with the test pulse
SERVICES = ("arm", "disarm", "emergency_stop", "release_emergency_stop", "clear_fault")


class DriverServices:
    """`link()` is the open supply or None; `check_arming()` and `check_clearing()` raise RefusedError.

    While `unchanging` is held, the node neither deactivates nor closes the port.
    """

    def __init__(
        self,
        node: Node,
        group: CallbackGroup,
        link: Callable[[], SupplyLink | None],
        unchanging: AbstractContextManager,
        check_arming: Callable[[], None],
        check_clearing: Callable[[], None],
        release_stop: Callable[[], list[str]],
        armed: Callable[[], None],
        rivals: Callable[[], list[str]],
    ) -> None:
        self._node, self._link, self._unchanging = node, link, unchanging
        self._check_arming, self._check_clearing = check_arming, check_clearing
        self._release_stop, self._armed, self._rivals = release_stop, armed, rivals
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
        self._armed()
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
        self._check_clearing()
        link.wait_for(lambda now: now.status.quiet is not False, PROOF_TIMEOUT_S)
        link.ask("clear_fault")
        return "Cleared: STANDBY, disarmed."

    def release_emergency_stop(self) -> str:
        """Take back what the topic's publishers hold; the fault stays until it is cleared."""
        names = self._release_stop()
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
        rivals = self._rivals()
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
