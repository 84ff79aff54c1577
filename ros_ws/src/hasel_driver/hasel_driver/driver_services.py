"""The services that arm, stop and clear: each answers for what the supply reports, and only as the only driver."""

from collections.abc import Callable
from concurrent.futures import Future
from functools import partial
from typing import Any

from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from std_srvs.srv import Trigger

from hasel_driver.errors import DriverError, RefusedError
from hasel_driver.faults import Fault, FaultCode
from hasel_driver.messages import OUTPUT_WORDS
from hasel_driver.mode import Mode
from hasel_driver.supply_thread import SupplyThread

PROOF_TIMEOUT_S = 0.4
ARMING_TIMEOUT_S = 1.0  # with the test pulse
SERVICES = ("arm", "disarm", "emergency_stop", "release_emergency_stop", "clear_fault")


class DriverServices:
    """`thread()` is the running supply or None; `check_arming()` and `check_clearing()` raise RefusedError."""

    def __init__(
        self,
        node: Node,
        group: CallbackGroup,
        thread: Callable[[], SupplyThread | None],
        check_arming: Callable[[], None],
        check_clearing: Callable[[], None],
        release_stop: Callable[[], list[str]],
        armed: Callable[[], None],
        rivals: Callable[[], list[str]],
    ) -> None:
        self._node, self._thread = node, thread
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
        thread = self._require_thread()
        supervisor = thread.supervisor

        def arm_if_allowed() -> None:  # in the thread, so that no stop or deactivation comes between
            self._check_arming()
            supervisor.arm()
            self._armed()

        _result(thread.call(arm_if_allowed))
        decided = thread.expect(
            lambda: supervisor.status().mode is Mode.ARMED or not supervisor.armed, ARMING_TIMEOUT_S
        )
        if not _result(decided) or not supervisor.armed:
            thread.call(supervisor.disarm)
            raise RefusedError(f"The supply did not arm: {supervisor.refusal or supervisor.status()}.")
        self._node.get_logger().warning("Armed: high voltage may be on the output from now on.")
        return "Armed, 0 V."

    def disarm(self) -> str:
        """To STANDBY, from everywhere but FAULT."""
        thread = self._require_thread()
        _result(thread.call(thread.supervisor.disarm))
        return self._prove_grounded(thread, "Disarmed")

    def emergency_stop(self) -> str:
        """To FAULT, from everywhere."""
        thread = self._require_thread()
        thread.call(lambda: thread.supervisor.fail(Fault(FaultCode.EMERGENCY_STOP, "by service")))
        return self._prove_grounded(thread, "Stopped", PROOF_TIMEOUT_S)

    def clear_fault(self) -> str:
        """FAULT to STANDBY."""
        thread = self._require_thread()
        self._check_clearing()
        supervisor = thread.supervisor
        _result(thread.expect(lambda: supervisor.status().quiet is not False, PROOF_TIMEOUT_S))
        _result(thread.call(supervisor.clear_fault))
        return "Cleared: STANDBY, disarmed."

    def release_emergency_stop(self) -> str:
        """Take back what the topic's publishers hold; the fault stays until it is cleared."""
        names = self._release_stop()
        if not names:
            return "Nobody held the emergency stop."
        return f"Released what {', '.join(names)} held; now clear the fault."

    def _prove_grounded(self, thread: SupplyThread, done: str, for_proof_s: float = 0.0) -> str:
        """The answer once the output is commanded to ground, or so much later, if the proof does not come before."""
        supervisor = thread.supervisor

        def off() -> bool:
            status = supervisor.status()
            return status.quiet is True and not status.mode.may_be_live

        if _result(thread.expect(off, PROOF_TIMEOUT_S)):
            if for_proof_s:
                _result(thread.expect(lambda: supervisor.status().output == "grounded", for_proof_s))
            return self._for_all(f"{done}. {OUTPUT_WORDS[supervisor.status().output]}")
        if not supervisor.capabilities.proves_grounded and supervisor.connected:
            return self._for_all(
                f"{done}: the supply was switched off, but this kind cannot prove its output grounded."
            )
        unproven = Fault(FaultCode.GROUND_NOT_PROVEN, f"{done.lower()} {PROOF_TIMEOUT_S} s ago")
        _result(thread.call(lambda: supervisor.fail(unproven)))
        raise RefusedError(f"{done}, but NOT proven: {supervisor.status()}. Treat the output as live.")

    def _for_all(self, answer: str) -> str:
        """The answer, where this driver is the only one; else it would stand for supplies that it does not know."""
        rivals = self._rivals()
        if rivals:
            raise RefusedError(
                f"{answer} That is true of this supply only: {1 + len(rivals)} drivers answer to this name,"
                f" also {', '.join(rivals)}. Treat every output as live, stop each, and end all but one."
            )
        return answer

    def _require_thread(self) -> SupplyThread:
        thread = self._thread()
        if thread is None:
            raise RefusedError("The port is closed: configure the node (lifecycle) first.")
        if not thread.is_alive():
            raise RefusedError(
                "The supply's thread has ended, so the board grounds itself: clean up and configure."
            )
        return thread


def _result(future: Future) -> Any:
    return future.result(timeout=10.0)
