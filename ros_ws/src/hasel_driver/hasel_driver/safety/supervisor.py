# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Decides what the supply may do: arming, limits, timeouts, latched faults. No threads, no ROS.

What it tells about the output comes from the supply's own recent report, never from what was asked for.
"""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import replace

from hasel_driver.protocol.faults import (
    BORNE_AT_REST,
    NEED_PROOF,
    Fault,
    FaultCode,
    LimitError,
    PortError,
    RefusedError,
    SupplyFaultError,
)
from hasel_driver.protocol.limits import Limits, Voltages, clip
from hasel_driver.protocol.status import UNKNOWN, Ground, Mode, SupplyStatus
from hasel_driver.protocol.waveform import Waveform
from hasel_driver.safety.supply_checks import STALE_S, OutputWatch, Sight, Watch, volts
from hasel_driver.supplies.supply import Capabilities, Reading, Supply

COMMAND_TIMEOUT_S = 0.2
STOP_REPEAT_S = 0.05
IDLE_DISARM_S = 60.0
FIRST_READING_S = 0.5
SETTLING_S = 0.05  # after which a report tells what a voltage asked for has done
REOPEN_S = 0.03  # lets the other end notice that the port was closed


class Supervisor:
    """One supply, one master. Every method is called by the same thread."""

    def __init__(
        self, supply: Supply, clock: Callable[[], float], idle_disarm_s: float = IDLE_DISARM_S
    ) -> None:
        self._supply, self._clock = supply, clock
        self.idle_disarm_s = idle_disarm_s  # armed and unused for so long, it is disarmed
        self._inherited: Fault | None = None
        self.name: str | None = None  # of the device; None while not connected
        self.fault: Fault | None = None
        self.rejected_commands = self.garbled_lines = 0
        self._reading: Reading | None = None
        self._armed_wanted = False
        self._requested_s = -math.inf  # when a change of mode was last asked for
        self._stop_sent_s = -math.inf
        self._command_expires_s: float | None = None
        self._experiment_running = False
        self._proving = self._zero_seen = False  # since the last arming
        self._used_s = -math.inf  # when somebody last made use of being armed
        self._note = ""  # why it disarmed itself
        self._watch, self._outputs = Watch(), OutputWatch()
        self._unfollowed: str | None = None
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
        self._open()
        self.fault = self.fault or self._inherited

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

    def status(self) -> SupplyStatus:
        """The present state, as far as it is known."""
        now_s = self._clock()
        reading = self._fresh_reading(now_s)
        if reading is None:
            at_rest = self._reading_at_rest() if self.fault is None else None
            silent_s = 0.0 if at_rest is None else now_s - at_rest.time_s
            mode = Mode.STANDBY if silent_s else Mode.FAULT
            unknown = SupplyStatus(now_s, mode, self.fault, None, UNKNOWN, UNKNOWN, UNKNOWN)
            return replace(unknown, silent_s=silent_s, note=self._note)
        ground = self._ground(reading)
        mode = Mode.ACTIVE if ground is Ground.NOT and reading.mode is not Mode.FAULT else reading.mode
        mode = Mode.FAULT if self.fault else mode
        values = (reading.commanded_v, reading.measured_v, reading.current_a)
        known = SupplyStatus(reading.time_s, mode, self.fault, ground, *values, reading.interlock_closed)
        return replace(known, note=self._note)

    def arm(self) -> None:
        """Ask the supply to arm, which begins with the proof of its ground. Raises RefusedError unless in STANDBY."""
        status = self.status()
        unproven = self.capabilities.proves_grounded and status.quiet is False
        if status.mode is not Mode.STANDBY and not (unproven and status.mode is Mode.ACTIVE):
            raise RefusedError(f"Arming needs the state STANDBY, it is {status}: see to that first.")
        if status.silent_s:
            raise RefusedError(
                f"The supply has not reported for {status.silent_s:.1f} s, so nothing is known of its output:"
                " arm when it does; if it does not, look at its cable and power."
            )
        if unproven:
            raise RefusedError(
                f"Arming needs a discharged output, it is {status}, {volts(status.measured_v)} measured:"
                " treat it as live, find out why, and use the ground stick."
            )
        self._command_expires_s, self._note = None, ""
        self._armed_wanted, self._zero_seen = True, False
        self._proving = self.capabilities.proves_grounded
        self._requested_s = self._used_s = self._clock()
        self._outputs.restart()
        self._guard(self._supply.arm)

    def disarm(self) -> None:
        """Ask the supply for STANDBY; allowed in every state."""
        self._armed_wanted, self._note = False, ""
        self._requested_s = self._clock()
        self._end_drive()
        if self.connected:
            self._guard(self._supply.disarm)

    def fail(self, fault: Fault) -> None:
        """Latch `fault` and ground the output; the first fault stays, but an emergency stop replaces it, or is shown
        beside it, where replacing would take away that a proof is needed.
        """
        stop = fault.code is FaultCode.EMERGENCY_STOP
        if self.fault is None or (stop and self.fault.code not in NEED_PROOF):
            self.fault = fault
        elif stop:
            self.fault = self.fault.beside(fault)
        self._armed_wanted = False
        self._end_drive()
        if fault.code is FaultCode.LINK_LOST:
            self.name = None
            self._supply.close()
        self._send_stop()

    def clear_fault(self) -> None:
        """Connect anew, which proves board and limits, and forget the fault; a lost port is opened again.

        A fault that needs it is forgotten only with a proof of the ground contacts. Raises RefusedError while the
        output is live or the interlock open, or PortError; then the fault stays.
        """
        if self.fault is None:
            raise RefusedError(f"There is no fault to clear: the state is {self.status()}.")
        status = self.status()
        if status.quiet is False:
            raise RefusedError("The supply does not report its output grounded: wait, or cut its power.")
        if status.interlock_closed and not all(status.interlock_closed):
            raise RefusedError("The interlock is open: close both of its channels first.")
        prove = self._needs_proof(self.fault)
        reading = self._open_anew(prove)
        if not prove and self._needs_proof(self._inherited):  # which a stop had hidden
            prove, reading = True, self._open_anew(True)
        ground = self._ground(reading)
        found = reading.fault
        if found is None and (ground is Ground.NOT or (prove and ground is not Ground.PROVEN)):
            found = Fault(FaultCode.GROUND_NOT_PROVEN, f"{volts(reading.measured_v)} measured")
        self.fault = found and found.beside(self.fault)
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
        if self._proving or not (self._zero_seen or not any(applied)):
            self.rejected_commands += 1  # who commands must begin at 0 V
            return
        self._zero_seen = True
        self._used_s = self._clock()
        self._command_expires_s = self._used_s + COMMAND_TIMEOUT_S - max(age_s, 0.0)
        self._drive(applied)

    def await_zero(self) -> None:
        """Another commander: it must begin at 0 V."""
        self._zero_seen = False

    def lower_maximum(self, voltage_v: float) -> None:
        """From now on a lower limit [V], in any state; raises RefusedError for a higher one."""
        if not voltage_v <= self.maximum_voltage_v:
            raise RefusedError(
                f"The limit is {self.maximum_voltage_v:g} V and can only be lowered while the port is open,"
                f" not set to {voltage_v:g} V: deactivate and clean up the node to raise it."
            )
        self._watch.forget()
        self._outputs.restart()
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
        self._used_s = self._clock()
        self._end_drive()
        if self._armed_wanted:
            self._guard(self._supply.ground)

    def service(self) -> bool:
        """Read, check, and send what is due; True when a new reading came."""
        if not self.connected:
            return False
        now_s = self._clock()
        readings: list[Reading] = []
        self._guard(lambda: readings.extend(self._supply.service(now_s, heartbeat=self._armed_wanted)))
        for reading in readings:
            self._reading = reading
            self._judge(reading)
        self._look(now_s)
        return bool(readings)

    def _needs_proof(self, fault: Fault | None) -> bool:
        return self.capabilities.proves_grounded and fault is not None and fault.code in NEED_PROOF

    def _open_anew(self, prove: bool) -> Reading:
        self.disconnect()
        time.sleep(REOPEN_S)
        return self._open(prove)

    def _open(self, prove: bool = False) -> Reading:
        connection = self._supply.open(prove)
        try:
            reading = self._reading = self._first_reading(connection.name)
        except PortError:
            self._supply.close()
            raise
        self.name = connection.name
        self._inherited = connection.fault
        self._watch.forget()
        self._outputs, self._unfollowed = OutputWatch(), None
        self._armed_wanted = self._proving = False
        self._requested_s, self._note = self._clock(), ""
        return reading

    def _first_reading(self, name: str) -> Reading:
        deadline_s = self._clock() + FIRST_READING_S
        while self._clock() < deadline_s:
            try:
                readings = self._supply.service(self._clock(), heartbeat=False)
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

    def _ground(self, reading: Reading) -> Ground | None:
        """What a report proves now: one of an armed supply nothing, if a voltage was asked for since."""
        outdated = reading.time_s < self._driven_s + SETTLING_S
        return None if reading.ground and reading.mode.may_be_live and outdated else reading.ground

    def _judge(self, reading: Reading) -> None:
        if reading.fault is not None:
            self._latch_board_fault(reading.fault)
        elif self._armed_wanted and self._supply.refusal is not None:
            self._armed_wanted = False
        elif reading.mode is Mode.ARMED:
            self._proving = False
        self._unfollowed = self._outputs.take(reading, self.limits.slew_v_per_ms)

    def _latch_board_fault(self, fault: Fault) -> None:
        self.fault = self.fault or fault
        self._armed_wanted = False
        self._end_drive()

    def _look(self, now_s: float) -> None:
        if self._command_expires_s is not None and now_s > self._command_expires_s:
            self._command_expires_s = None
            self._guard(self._supply.ground)
        fresh = self._fresh_reading(now_s)
        if self.fault is None:
            asked_s = now_s - self._requested_s
            sight = Sight(fresh, self.limits, self._armed_wanted, self._proving, asked_s, self._unfollowed)
            found = self._watch.look(sight, now_s)
            if found is not None:
                self._take(Fault(*found))
        if self._armed_wanted and not self._experiment_running and now_s - self._used_s > self.idle_disarm_s:
            self.disarm()
            self._note = (
                f"disarmed by itself, as no command and no experiment came for {self.idle_disarm_s:g} s:"
                " arm again to go on"
            )
        proven = fresh is not None and not fresh.mode.may_be_live
        if self.fault is not None and not proven and now_s - self._stop_sent_s > STOP_REPEAT_S:
            self._send_stop()

    def _at_rest(self) -> bool:
        """Nothing is armed, and the board's last word, however old, is that."""
        return self._reading_at_rest() is not None

    def _reading_at_rest(self) -> Reading | None:
        """The board's last word, however old, where nothing is armed and it says so too."""
        reading = self._reading if self.connected and not self._armed_wanted else None
        return reading if reading is not None and not reading.mode.may_be_live else None

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
            self._take(problem.fault)

    def _take(self, fault: Fault) -> None:
        if fault.code is FaultCode.GARBAGE_RECEIVED:
            self.garbled_lines += 1
        if not (fault.code in BORNE_AT_REST and self._at_rest()):
            self.fail(fault)
