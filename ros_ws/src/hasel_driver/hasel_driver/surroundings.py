"""What other nodes must not do: hold a stop, be a second driver or commander, say a stop that cannot be heard."""

import time
from dataclasses import dataclass

from hasel_driver.errors import RefusedError
from hasel_driver.faults import Fault, FaultCode
from hasel_driver.graph_names import UNNAMED
from hasel_driver.rivals import NOT_TOLD
from hasel_driver.urgent_inputs import UrgentInputs

DISCOVERY_S = 1.0  # for which a new publisher may be known and not yet connected
NAMING_S = 0.15  # within which another driver's name and host are learnt


@dataclass
class _Lasting:
    """How long something has been true without a break."""

    _since_s: float | None = None

    def for_s(self, true: bool) -> float:
        now_s = time.monotonic()
        self._since_s = (now_s if self._since_s is None else self._since_s) if true else None
        return 0.0 if self._since_s is None else now_s - self._since_s


class HostSurroundings:
    """Asked before arming and clearing, and for a fault while armed."""

    def __init__(self, inputs: UrgentInputs) -> None:
        self._inputs = inputs
        self._unheard, self._rivals = _Lasting(), _Lasting()

    def check_clearing(self) -> None:
        """Raises RefusedError while somebody holds the emergency stop."""
        inputs = self._inputs
        if inputs.holders:
            raise RefusedError(
                f"The emergency stop is held by {', '.join(inputs.holders.names(inputs.stop_topic.present()))}:"
                " publish false there first, or call the service release_emergency_stop."
            )

    def check_arming(self) -> None:
        """Raises RefusedError for what would be a fault, or a doubt, while armed."""
        self.check_clearing()
        inputs = self._inputs
        unheard = inputs.stop_topic.unheard()
        if unheard is not None:
            raise RefusedError(f"An emergency stop might not be heard: {unheard}. Correct that, then arm.")
        rivals = inputs.rivals.found()
        if rivals:
            raise RefusedError(
                f"Another driver answers to the names of this one: {', '.join(rivals)}."
                " End it, or give each a namespace of its own."
            )
        if not inputs.rivals.known:
            raise RefusedError(
                "Whether another driver answers to these names is not known yet: arm again in a moment."
            )
        commanders = inputs.commanders()
        if len(commanders) > 1:
            raise RefusedError(
                f"More than one node publishes {inputs.command_topic}: {', '.join(sorted(commanders.values()))}."
                " End all but one, then arm."
            )

    def threat(self) -> Fault | None:
        """What ends arming now; to be asked often while armed."""
        rivals = self._inputs.rivals.found()
        named = not any(NOT_TOLD in words or UNNAMED in words for words in rivals)
        rival_s = self._rivals.for_s(bool(rivals))
        if rivals and (named or rival_s > NAMING_S):
            return Fault(FaultCode.TWO_DRIVERS, ", ".join(rivals))
        unheard = self._inputs.stop_topic.unheard()
        if self._unheard.for_s(unheard is not None) > DISCOVERY_S:
            return Fault(FaultCode.STOP_NOT_HEARD, unheard or "")
        return None

    def calm(self) -> None:
        """Nothing is armed: what lasts begins anew."""
        self._unheard, self._rivals = _Lasting(), _Lasting()
