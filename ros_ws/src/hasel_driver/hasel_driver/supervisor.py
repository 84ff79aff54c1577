"""Decides what the supply may do: arming, limits, timeouts, latched faults. No threads, no ROS.

What it tells about the output comes from the supply's own recent report, never from what was asked for.
"""

import math
import time
from collections.abc import Callable, Sequence

from hasel_driver.errors import LimitError, PortError, RefusedError
from hasel_driver.faults import Fault, FaultCode, SupplyFaultError
from hasel_driver.limits import Limits, Voltages, clip
from hasel_driver.mode import Mode
from hasel_driver.status import UNKNOWN, Status
from hasel_driver.supply import Capabilities, Connection, Reading, Supply
from hasel_driver.waveform import Waveform

COMMAND_TIMEOUT_S = 0.2
STALE_S = 0.2
TRANSITION_S = 0.3  # time the board has to follow a request
STOP_REPEAT_S = 0.05
FIRST_READING_S = 0.5
SETTLING_S = 0.05  # after which a report tells what a voltage asked for has done
GROUND_PROOF_S = 0.3  # a supply that should be grounded, and is not, is a fault after that
ABOVE_MAXIMUM_S = (
    0.2  # so long may more than the maximum be read: after it was lowered, muscles discharge first
)
REOPEN_S = 0.03  # lets the other end notice that the port was closed


class Supervisor:
    """One supply, one master. Every method is called by the same thread."""

    def __init__(self, supply: Supply, clock: Callable[[], float]) -> None:
        self._supply, self._clock = supply, clock
        self.name: str | None = None  # of the device; None while not connected
        self.fault: Fault | None = None
        self.rejected_commands = 0
        self._reading: Reading | None = None
        self._armed_wanted = False
        self._requested_s = -math.inf  # when a change of mode was last asked for
        self._stop_sent_s = -math.inf
        self._command_expires_s: float | None = None
        self._experiment_running = False
        self._ungrounded_s: float | None = None  # since when there is no proof of a ground that should be
        self._above_s: float | None = None  # since when more than the maximum is read
        self._driven_s = -math.inf  # when a voltage was last asked for; infinite while a waveform runs

    @property
    def maximum_voltage_v(self) -> float:
        """Limit to which commands are clipped [V]."""
        return self._supply.limits.maximum_voltage_v

    @property
    def limits(self) -> Limits:
        """Those that the supply works within."""
        return self._supply.limits

    @property
    def connected(self) -> bool:
        """Whether the port is open and has not failed."""
        return self.name is not None

    def connect(self) -> None:
        """Open the supply, disarmed; a fault the board had kept is latched here. Raises PortError."""
        connection = self._open()
        self.fault = self.fault or connection.fault

    def disconnect(self) -> None:
        """Disarm and close the port."""
        self._armed_wanted = False
        self.name = None
        self._reading = None
        self._supply.close()

    @property
    def capabilities(self) -> Capabilities:
        """What this kind of supply can do."""
        return self._supply.capabilities

    @property
    def armed(self) -> bool:
        """Whether high voltage was asked for and not withdrawn."""
        return self._armed_wanted

    @property
    def refusal(self) -> str | None:
        """Why the supply did not arm, in its own words."""
        return self._supply.refusal

    def status(self) -> Status:
        """The present state, as far as it is known."""
        now_s = self._clock()
        reading = self._fresh_reading(now_s)
        if reading is None:
            return Status(now_s, Mode.FAULT, self.fault, None, UNKNOWN, UNKNOWN, UNKNOWN)
        grounded = self._grounded(reading)
        mode = Mode.ACTIVE if grounded is False and reading.mode is not Mode.FAULT else reading.mode
        mode = Mode.FAULT if self.fault else mode
        values = (reading.commanded_v, reading.measured_v, reading.current_a)
        return Status(reading.time_s, mode, self.fault, grounded, *values, reading.interlock_closed)

    def arm(self) -> None:
        """Ask the supply to arm. Raises RefusedError unless STANDBY is proven."""
        status = self.status()
        unproven = self.capabilities.proves_grounded and status.grounded is False
        if status.mode is not Mode.STANDBY and not (unproven and status.mode is Mode.ACTIVE):
            raise RefusedError(f"Arming needs the state STANDBY, it is {status}: see to that first.")
        if unproven:
            raise RefusedError(
                f"Arming needs an output proven grounded, it is {status}, {_volts(status.measured_v)} measured:"
                " treat it as live, find out why, and use the ground stick."
            )
        self._command_expires_s = None
        self._armed_wanted = True
        self._requested_s = self._clock()
        self._guard(self._supply.arm)

    def disarm(self) -> None:
        """Ask the supply for STANDBY; allowed in every state."""
        self._armed_wanted = False
        self._requested_s = self._clock()
        self._end_drive()
        if self.connected:
            self._guard(self._supply.disarm)

    def fail(self, fault: Fault) -> None:
        """Latch `fault` and ground the output; the first fault stays, but an emergency stop replaces it."""
        if self.fault is None or fault.code is FaultCode.EMERGENCY_STOP:
            self.fault = fault
        self._armed_wanted = False
        self._end_drive()
        if fault.code is FaultCode.LINK_LOST:
            self.name = None
            self._supply.close()
        self._send_stop()

    def clear_fault(self) -> None:
        """Connect anew, which proves board and limits, and forget the fault; a lost port is opened again.

        Raises RefusedError while the output is live, or PortError; then the fault stays.
        """
        if self.fault is None:
            raise RefusedError(f"There is no fault to clear: the state is {self.status()}.")
        if self.status().grounded is False:
            raise RefusedError("The supply does not report its output grounded: wait, or cut its power.")
        self.disconnect()
        time.sleep(REOPEN_S)
        self._open()
        self.fault = self._reading.fault
        if self.fault is None and self._grounded(self._reading) is False:
            self.fault = Fault(FaultCode.GROUND_NOT_PROVEN, f"{_volts(self._reading.measured_v)} measured")
        if self.fault is not None:
            raise RefusedError(f"The fault came back at once: {self.fault}.")

    def command(self, voltage_v: Sequence[float], age_s: float = 0.0) -> None:
        """A voltage from outside [V], `age_s` old; clipped, held for 200 ms from its making, else ignored."""
        try:
            applied = clip(voltage_v, self.maximum_voltage_v, self._supply.capabilities.bipolar)
        except LimitError as error:
            self.rejected_commands += 1
            if self._armed_wanted:
                self.fail(Fault(FaultCode.INVALID_COMMAND, str(error)))
            return
        if self._experiment_running:
            self.fail(Fault(FaultCode.TWO_MASTERS, "a voltage was commanded while an experiment runs"))
            return
        if not self._armed_wanted or not abs(age_s) < COMMAND_TIMEOUT_S or not self.status().mode.may_be_live:
            self.rejected_commands += 1
            return
        self._command_expires_s = self._clock() + COMMAND_TIMEOUT_S - max(age_s, 0.0)
        self._drive(applied)

    def lower_maximum(self, voltage_v: float) -> None:
        """From now on a lower limit [V], in any state; raises RefusedError for a higher one."""
        if not voltage_v <= self.maximum_voltage_v:
            raise RefusedError(
                f"The limit is {self.maximum_voltage_v:g} V and can only be lowered while the port is open,"
                f" not set to {voltage_v:g} V: deactivate and clean up the node to raise it."
            )
        self._above_s = None
        self._guard(lambda: self._supply.lower_maximum(voltage_v))

    def begin_experiment(self) -> None:
        """From here on commands from outside are a second master. Raises RefusedError unless armed at 0 V."""
        status = self.status()
        if status.mode is not Mode.ARMED or not self._armed_wanted:
            raise RefusedError(
                f"An experiment needs the state ARMED, it is {status}: arm first, and command nothing else."
            )
        self._command_expires_s = None
        self._experiment_running = True

    def start(self, waveform: Waveform) -> None:
        """Run the experiment's waveform on the board."""
        if self._experiment_running:
            self._driven_s = math.inf
            self._guard(lambda: self._supply.start(waveform))

    def hold(self, voltage_v: Voltages) -> None:
        """The experiment's voltage [V], where the driver makes the waveform; expires as a command does."""
        if self._experiment_running:
            applied = clip(voltage_v, self.maximum_voltage_v, self._supply.capabilities.bipolar)
            self._command_expires_s = self._clock() + COMMAND_TIMEOUT_S
            self._drive(applied)

    def end_experiment(self) -> None:
        """0 V now, without waiting for the slew limit; still armed."""
        self._end_drive()
        if self._armed_wanted:
            self._guard(self._supply.ground)

    def service(self) -> bool:
        """Read, check, and send what is due; True when a new reading came."""
        if not self.connected:
            return False
        now_s = self._clock()
        readings: list[Reading] = []
        self._guard(lambda: readings.extend(self._supply.service(now_s, self._may_keep_alive())))
        for reading in readings:
            self._reading = reading
            self._judge(reading, now_s)
        self._watch(now_s)
        return bool(readings)

    def _open(self) -> Connection:
        connection = self._supply.open()
        try:
            self._reading = self._first_reading(connection.name)
        except PortError:
            self._supply.close()
            raise
        self.name = connection.name
        self._ungrounded_s = self._above_s = None
        self._armed_wanted = False
        self._requested_s = self._clock()
        return connection

    def _first_reading(self, name: str) -> Reading:
        deadline_s = self._clock() + FIRST_READING_S
        while self._clock() < deadline_s:
            try:
                readings = self._supply.service(self._clock(), heartbeat=True)
            except SupplyFaultError as problem:
                raise PortError(f"{name} failed when it was opened: {problem}.") from problem
            if readings:
                return readings[-1]
            time.sleep(0.002)
        raise PortError(f"{name} did not report its state: check the line, and reset the board.")

    def _drive(self, voltage_v: Voltages) -> None:
        if any(voltage_v):
            self._driven_s = self._clock()
        self._guard(lambda: self._supply.set_voltage(voltage_v))

    def _end_drive(self) -> None:
        self._command_expires_s, self._experiment_running = None, False
        self._driven_s = min(self._driven_s, self._clock())

    def _grounded(self, reading: Reading) -> bool | None:
        """What a report proves now: one of an armed supply nothing, if a voltage was asked for since."""
        outdated = reading.time_s < self._driven_s + SETTLING_S
        return None if reading.grounded and reading.mode.may_be_live and outdated else reading.grounded

    def _judge(self, reading: Reading, now_s: float) -> None:
        if reading.fault is not None:
            self._latch_board_fault(reading.fault)
        elif self._armed_wanted and self._supply.refusal is not None:
            self._armed_wanted = False
        elif self.fault is None and reading.mode.may_be_live != self._armed_wanted:
            self._await_transition(reading.mode, now_s)

    def _await_transition(self, mode: Mode, now_s: float) -> None:
        if now_s - self._requested_s > TRANSITION_S:
            wanted = "armed" if self._armed_wanted else "disarmed"
            self.fail(Fault(FaultCode.UNEXPECTED_STATE, f"{mode.name}, {wanted} was asked for"))

    def _latch_board_fault(self, fault: Fault) -> None:
        self.fault = self.fault or fault
        self._armed_wanted = False
        self._end_drive()

    def _watch(self, now_s: float) -> None:
        if self.fault is None and self._fresh_reading(now_s) is None:
            self.fail(Fault(FaultCode.NO_TELEMETRY, f"none for {STALE_S} s"))
        if self._command_expires_s is not None and now_s > self._command_expires_s:
            self._command_expires_s = None
            self._guard(self._supply.ground)
        fresh = self._fresh_reading(now_s)
        if fresh is not None and self.fault is None:
            self._watch_ground(fresh, now_s)
            self._watch_maximum(fresh, now_s)
        proven = fresh is not None and not fresh.mode.may_be_live
        if self.fault is not None and not proven and now_s - self._stop_sent_s > STOP_REPEAT_S:
            self._send_stop()

    def _watch_ground(self, reading: Reading, now_s: float) -> None:
        should_be = reading.mode is Mode.STANDBY or not any(reading.commanded_v)
        if reading.grounded is not False or not should_be:
            self._ungrounded_s = None
            return
        self._ungrounded_s = now_s if self._ungrounded_s is None else self._ungrounded_s
        limits = self._supply.limits
        ramp_s = limits.maximum_voltage_v / limits.slew_v_per_ms * 1e-3 if reading.mode.may_be_live else 0.0
        if now_s - self._ungrounded_s > GROUND_PROOF_S + ramp_s:
            self.fail(Fault(FaultCode.GROUND_NOT_PROVEN, f"{_volts(reading.measured_v)} measured"))

    def _watch_maximum(self, reading: Reading, now_s: float) -> None:
        maximum_v = self.maximum_voltage_v
        if not max(map(abs, reading.measured_v)) > max(1.05 * maximum_v, maximum_v + 100.0):
            self._above_s = None
            return
        self._above_s = now_s if self._above_s is None else self._above_s
        if now_s - self._above_s > ABOVE_MAXIMUM_S:
            self.fail(
                Fault(FaultCode.ABOVE_MAXIMUM, f"{_volts(reading.measured_v)}, {maximum_v:g} V is allowed")
            )

    def _may_keep_alive(self) -> bool:
        """An armed board gets heartbeats only while nothing is wrong, so that its own timeout can work."""
        return self._armed_wanted or (self._reading is not None and not self._reading.mode.may_be_live)

    def _fresh_reading(self, now_s: float) -> Reading | None:
        if self._reading is None or not self.connected or now_s - self._reading.time_s > STALE_S:
            return None
        return self._reading

    def _send_stop(self) -> None:
        self._stop_sent_s = self._clock()
        if self.connected:
            try:
                self._supply.stop()
            except SupplyFaultError:
                self.name = None
                self._supply.close()

    def _guard(self, action: Callable[[], None]) -> None:
        try:
            action()
        except SupplyFaultError as problem:
            self.fail(problem.fault)


def _volts(voltage_v: Voltages) -> str:
    return f"{voltage_v[0]:.0f} and {voltage_v[1]:.0f} V"
