# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The rules of arming, limits, timeouts and faults, on a supply that does what it is told, or does not."""

import math
from dataclasses import replace

import pytest
from hasel_driver.protocol.faults import Fault, FaultCode, RefusedError, SupplyFaultError
from hasel_driver.protocol.limits import Limits
from hasel_driver.protocol.status import Ground, Mode
from hasel_driver.protocol.waveform import Waveform
from hasel_driver.safety.supervisor import Supervisor
from hasel_driver.supplies.supply import Capabilities, Connection, Reading, Supply
from hypothesis import given, settings
from hypothesis import strategies as st

ZERO = (0.0, 0.0)


class Clock:
    """Time that a test advances."""

    def __init__(self) -> None:
        self.now_s = 100.0

    def __call__(self) -> float:
        return self.now_s


class ObedientSupply(Supply):
    """Does at once what it is asked, unless `deaf`, `silent` or `broken`."""

    capabilities = Capabilities(deadman=True, proves_grounded=True, bipolar=True, waveforms=True)

    def __init__(self) -> None:
        super().__init__(Limits(maximum_voltage_v=5000.0))
        self.mode, self.voltage_v, self.fault = Mode.STANDBY, ZERO, None
        self.deaf = self.silent = self.broken = self.ungrounded = False
        self.measured_v, self.unproven = None, False
        self.reported: dict = {}
        self.heartbeats: list[bool] = []

    def open(self, prove: bool = False) -> Connection:
        self.mode, self.voltage_v, self.fault = Mode.STANDBY, ZERO, None
        return Connection("obedient")

    def close(self) -> None:
        self.disarm()

    def descriptors(self) -> list[int]:
        return []

    def service(self, now_s: float, heartbeat: bool) -> list[Reading]:
        if self.broken:
            raise SupplyFaultError(FaultCode.GARBAGE_RECEIVED)
        self.heartbeats.append(heartbeat)
        if self.silent:
            return []
        grounded = self.voltage_v == ZERO and not self.ungrounded
        values = (self.voltage_v, self.measured_v or self.voltage_v, ZERO)
        ground = (Ground.COMMANDED if self.unproven else Ground.PROVEN) if grounded else Ground.NOT
        return [replace(Reading(now_s, self.mode, ground, self.fault, *values), **self.reported)]

    def _become(self, mode: Mode, voltage_v=ZERO) -> None:
        if not self.deaf:
            self.mode, self.voltage_v = mode, voltage_v

    def arm(self) -> None:
        self._become(Mode.ARMED)

    def disarm(self) -> None:
        self._become(Mode.STANDBY)

    def stop(self) -> None:
        self._become(Mode.STANDBY)

    def set_voltage(self, voltage_v) -> None:
        self._become(Mode.ACTIVE if any(voltage_v) else Mode.ARMED, voltage_v)

    def start(self, waveform: Waveform) -> None:
        self._become(Mode.ACTIVE, (waveform.voltage_v, 0.0))


class Case:
    """A supervisor, its supply and its clock."""

    def __init__(self) -> None:
        self.supply, self.clock = ObedientSupply(), Clock()
        self.supervisor = Supervisor(self.supply, self.clock)
        self.supervisor.connect()

    def pass_time(self, duration_s: float) -> None:
        """Serve every 10 ms."""
        for _ in range(round(duration_s / 0.01)):
            self.clock.now_s += 0.01
            self.supervisor.service()

    def arm(self) -> None:
        """And let it happen."""
        self.supervisor.arm()
        self.pass_time(0.02)
        self.supervisor.command(ZERO)


@pytest.fixture
def case() -> Case:
    """A supervisor in STANDBY."""
    return Case()


def test_connecting_does_not_arm(case):
    """After connecting the state is STANDBY, by the supply's own report."""
    case.pass_time(1.0)
    assert case.supervisor.status().mode is Mode.STANDBY
    assert case.supervisor.status().output == "grounded"


def test_commands_before_arming_are_rejected_and_counted(case):
    """Nothing is sent unless armed."""
    case.supervisor.command((1000.0, 0.0))
    assert (case.supply.voltage_v, case.supervisor.rejected_commands) == (ZERO, 1)


def test_a_command_is_clipped_and_expires(case):
    """What is sent is within the limit, and zero 200 ms after the command was made."""
    case.arm()
    case.supervisor.command((9000.0, -9000.0), age_s=0.1)
    assert case.supply.voltage_v == (5000.0, -5000.0)
    case.pass_time(0.08)
    assert case.supply.voltage_v == (5000.0, -5000.0)
    case.pass_time(0.04)
    assert (case.supply.voltage_v, case.supply.mode) == (ZERO, Mode.ARMED)


@pytest.mark.parametrize("age_s", [0.2, 5.0, -0.2, math.nan])
def test_commands_of_another_time_are_rejected(case, age_s):
    """Too old, from the future, or of no time at all."""
    case.arm()
    case.supervisor.command((1000.0, 0.0), age_s)
    assert case.supply.voltage_v == ZERO


def test_old_reports_are_no_knowledge(case):
    """Without reports for 200 ms the state is FAULT and every value unknown."""
    case.arm()
    case.supervisor.command((1000.0, 0.0))
    case.supply.silent = True
    case.pass_time(0.25)
    status = case.supervisor.status()
    assert (status.mode, status.output, status.fault.code) == (Mode.FAULT, "unknown", FaultCode.NO_TELEMETRY)
    assert all(math.isnan(value) for value in (*status.commanded_v, *status.measured_v, *status.current_a))


@pytest.mark.parametrize("drive", ["command", "waveform", "hold"])
def test_a_report_from_before_the_voltage_proves_nothing(case, drive):
    """A supply that falls silent as it is driven is not called grounded by what it reported before."""
    supervisor = case.supervisor
    case.arm()
    assert supervisor.status().output == "grounded"
    case.supply.silent = True
    if drive == "command":
        supervisor.command((1000.0, 0.0))
    else:
        supervisor.begin_experiment()
        supervisor.start(Waveform("box", 1000.0, 1.0, 1)) if drive == "waveform" else supervisor.hold(
            (9.0, 0.0)
        )
    assert supervisor.status().output == "unknown"
    case.supply.deaf = True
    supervisor.fail(Fault(FaultCode.EMERGENCY_STOP))
    case.pass_time(0.1)
    assert supervisor.status().output == "unknown"


def test_a_report_from_after_the_voltage_proves_again(case):
    """Once the voltage has expired, the supply's next reports count."""
    case.arm()
    case.supervisor.command((1000.0, 0.0))
    case.pass_time(0.1)
    assert case.supervisor.status().output == "live"
    case.pass_time(0.2)
    assert str(case.supervisor.status()) == "ARMED, output grounded"


def test_no_heartbeat_for_a_supply_that_does_not_stop(case):
    """A supply that stays live in spite of a stop gets no more heartbeats, so that its own timeout works."""
    case.arm()
    case.supervisor.command((1000.0, 0.0))
    case.pass_time(0.02)
    case.supply.deaf = True
    case.supervisor.fail(Fault(FaultCode.EMERGENCY_STOP))
    case.supply.heartbeats.clear()
    case.pass_time(0.5)
    assert True not in case.supply.heartbeats
    assert case.supervisor.status().output == "live"
    with pytest.raises(RefusedError, match="does not report its output grounded"):
        case.supervisor.clear_fault()


def test_a_supply_that_disarms_itself_is_a_fault(case):
    """STANDBY that nobody asked for is not silently accepted, nor armed again."""
    case.arm()
    case.pass_time(0.5)
    case.supply.mode = Mode.STANDBY
    case.pass_time(0.5)
    assert case.supervisor.fault.code is FaultCode.UNEXPECTED_STATE
    assert case.supply.mode is Mode.STANDBY


def test_a_supply_that_arms_itself_is_stopped(case):
    """ARMED that nobody asked for is a fault, and is ended."""
    case.pass_time(0.5)
    case.supply.mode = Mode.ARMED
    case.pass_time(0.1)
    assert case.supervisor.fault.code is FaultCode.UNEXPECTED_STATE
    assert case.supply.mode is Mode.STANDBY


def test_the_first_fault_stays_but_an_emergency_stop_shows(case):
    """The cause is not overwritten by its consequences; an emergency stop always is seen."""
    case.supervisor.fail(Fault(FaultCode.DEVICE_RESET))
    case.supervisor.fail(Fault(FaultCode.NO_REPLY))
    assert case.supervisor.fault.code is FaultCode.DEVICE_RESET
    case.supervisor.fail(Fault(FaultCode.EMERGENCY_STOP))
    assert case.supervisor.fault.code is FaultCode.EMERGENCY_STOP


def test_faults_print_as_sentences():
    """Every code has words."""
    assert str(Fault(FaultCode.LINK_LOST, "/dev/ttyACM0")) == "the serial port is gone: /dev/ttyACM0"
    assert all(len(str(Fault(code))) > 5 for code in FaultCode)


ACTIONS = st.lists(
    st.sampled_from(
        ["arm", "disarm", "command", "nan", "fail", "clear", "begin", "start", "hold", "end", "break", "mend"]
        + ["silence", "wait", "wait longer"]
    ),
    max_size=40,
)


@settings(max_examples=300, deadline=None)
@given(ACTIONS)
def test_no_sequence_of_calls_leaves_voltage_where_it_must_not_be(actions):
    """In STANDBY and FAULT the supply is at 0 V; live needs an `arm` since the last disarm, fault or clear."""
    case, armed = Case(), False
    supervisor, supply = case.supervisor, case.supply
    calls = {
        "arm": case.arm,
        "disarm": supervisor.disarm,
        "command": lambda: supervisor.command((9000.0, -100.0)),
        "nan": lambda: supervisor.command((math.nan, 0.0)),
        "fail": lambda: supervisor.fail(Fault(FaultCode.EMERGENCY_STOP)),
        "clear": supervisor.clear_fault,
        "begin": supervisor.begin_experiment,
        "start": lambda: supervisor.start(Waveform("box", 3000.0, 1.0, 1)),
        "hold": lambda: supervisor.hold((3000.0, 0.0)),
        "end": supervisor.end_experiment,
        "break": lambda: setattr(supply, "broken", True),
        "mend": lambda: [setattr(supply, name, False) for name in ("broken", "silent")],
        "silence": lambda: setattr(supply, "silent", True),
        "wait": lambda: case.pass_time(0.05),
        "wait longer": lambda: case.pass_time(0.5),
    }
    for action in actions:
        if action == "clear" and (supply.broken or supply.silent):
            continue  # would wait for a supply that cannot answer
        try:
            calls[action]()
        except RefusedError:
            continue
        if action == "arm":
            armed = True
        elif action in ("disarm", "fail", "clear"):
            armed = False
        if supervisor.fault is not None or supervisor.status().mode is Mode.STANDBY:
            assert supply.voltage_v == ZERO
        assert armed or supply.voltage_v == ZERO
        assert max(map(abs, supply.voltage_v)) <= 5000.0


def test_a_ground_that_is_not_proven_is_a_fault(case):
    """STANDBY without proof is FAULT after 300 ms; until then arming is refused."""
    case.supply.ungrounded = True
    case.pass_time(0.02)
    with pytest.raises(RefusedError, match="discharged output"):
        case.supervisor.arm()
    case.pass_time(0.5)
    assert case.supervisor.fault.code is FaultCode.GROUND_NOT_PROVEN


def test_a_measured_voltage_above_the_maximum_is_a_fault(case):
    """The host does not rely on the board alone."""
    case.arm()
    case.supply.measured_v = (5400.0, 0.0)
    case.supervisor.command((5000.0, 0.0))
    case.pass_time(0.15)
    assert case.supervisor.fault is None
    case.supervisor.command((5000.0, 0.0))
    case.pass_time(0.15)
    assert case.supervisor.fault.code is FaultCode.ABOVE_MAXIMUM


def test_live_output_begins_at_zero(case):
    """A voltage that is commanded as the supply is armed waits for 0 V, and so does that of another commander."""
    case.supervisor.arm()
    case.pass_time(0.02)
    case.supervisor.command((1000.0, 0.0))
    assert case.supply.voltage_v == ZERO
    case.supervisor.command(ZERO)
    case.supervisor.command((1000.0, 0.0))
    assert case.supply.voltage_v == (1000.0, 0.0)
    case.supervisor.await_zero()
    case.supervisor.command((2000.0, 0.0))
    assert case.supply.voltage_v == (1000.0, 0.0)


def test_what_nobody_uses_is_disarmed(case):
    """Armed for a minute without a command or an experiment: STANDBY, and no fault; with commands it stays armed."""
    case.arm()
    for _ in range(7):
        case.pass_time(10.0)
        case.supervisor.command(ZERO)
    assert case.supervisor.armed
    case.pass_time(61.0)
    assert (case.supervisor.armed, case.supervisor.fault) == (False, None)
    assert case.supervisor.status().mode is Mode.STANDBY
    assert "disarmed by itself, as no command and no experiment came for 60 s" in str(
        case.supervisor.status()
    )
    case.arm()
    assert case.supervisor.status().note == ""


def test_a_gap_in_the_telemetry_is_borne_while_nothing_is_armed(case):
    """Unknown, however long, and no fault; nothing can be armed until the supply reports again."""
    case.pass_time(0.5)
    case.supply.silent = True
    case.pass_time(10.0)
    status = case.supervisor.status()
    assert (status.mode, status.output, status.fault) == (Mode.STANDBY, "unknown", None)
    assert status.silent_s == pytest.approx(10.0, abs=0.1)
    with pytest.raises(RefusedError, match="not reported for 10"):
        case.supervisor.arm()
    case.supply.silent = False
    case.pass_time(0.1)
    case.arm()
    assert case.supervisor.status().mode is Mode.ARMED


def test_a_supply_that_falls_silent_before_it_says_that_it_is_disarmed_is_a_fault(case):
    """What was armed by its last word is not at rest."""
    case.arm()
    case.supply.silent = True
    case.supervisor.disarm()
    case.pass_time(0.3)
    assert case.supervisor.fault.code is FaultCode.NO_TELEMETRY


def test_a_garbled_line_is_borne_while_nothing_is_armed(case):
    """As a gap begins and ends with; it is counted. Armed, it is a fault."""
    case.pass_time(0.5)
    case.supply.broken = True
    case.pass_time(0.01)
    case.supply.broken = False
    assert (case.supervisor.fault, case.supervisor.garbled_lines) == (None, 1)
    case.arm()
    case.supply.broken = True
    case.pass_time(0.01)
    assert case.supervisor.fault.code is FaultCode.GARBAGE_RECEIVED


BROKEN = {
    "blind": (lambda asked: 0.0, FaultCode.MONITOR),
    "a third": (lambda asked: asked / 3, FaultCode.MONITOR),
    "wrong sign": (lambda asked: -asked, FaultCode.MONITOR),
    "stuck as it rises": (lambda asked: 2600.0, FaultCode.MONITOR),
}


@pytest.mark.parametrize("how", BROKEN)
def test_a_monitor_that_does_not_follow_is_a_fault(case, how):
    """Within half a second of what it could be seen in, though the board says nothing."""
    read, code = BROKEN[how]
    case.arm()
    for step in range(100):
        asked_v = 2600.0 if step < 50 else 4000.0
        case.supply.measured_v = (asked_v if step < 50 else read(asked_v), 0.0)
        case.supervisor.command((asked_v, 0.0))
        case.pass_time(0.01)
    assert case.supervisor.fault.code is code


@pytest.mark.parametrize("slew_v_per_ms", [1.0, 250.0])
def test_a_monitor_that_follows_late_is_none(case, slew_v_per_ms):
    """The slew limit, a converter that lags by 50 ms, reversals and a lowered maximum are no blindness."""
    case.supply.limits = Limits(maximum_voltage_v=5000.0, slew_v_per_ms=slew_v_per_ms)
    case.arm()
    output_v, lag = 0.0, [0.0] * 5
    for step in range(3000):
        asked_v = 4000.0 * (1 if step // 700 % 2 else -1)
        if step == 2000:
            case.supervisor.lower_maximum(3000.0)
            output_v = 0.0
        asked_v = max(-case.supervisor.maximum_voltage_v, min(case.supervisor.maximum_voltage_v, asked_v))
        change_v = asked_v - output_v
        output_v += max(-10 * slew_v_per_ms, min(10 * slew_v_per_ms, change_v))
        if output_v * asked_v < 0:
            output_v = 0.0  # by way of ground
        lag = [*lag[1:], output_v]
        case.supply.measured_v = (lag[0] if lag[0] * asked_v >= 0 else 0.0, 0.0)
        case.supervisor.command((asked_v, 0.0))
        case.pass_time(0.01)
        assert case.supervisor.fault is None, (step, case.supervisor.fault)


@pytest.mark.parametrize(
    ("what", "code"), [("current_a", FaultCode.OVERCURRENT), ("interlock_closed", FaultCode.INTERLOCK)]
)
def test_the_host_does_not_rely_on_the_boards_trips(case, what, code):
    """900 µA that do not trip at 450, and an interlock that is open while the board stays armed."""
    case.arm()
    case.supply.reported = {what: {"current_a": (9e-4, 0.0), "interlock_closed": (True, False)}[what]}
    for _ in range(10):
        case.supervisor.command(ZERO)
        case.pass_time(0.02)
    assert case.supervisor.fault.code is code


def test_a_fault_that_needs_a_proof_is_not_cleared_without_one(case):
    """Contacts that are commanded to ground do not do."""
    case.supervisor.fail(Fault(FaultCode.NOT_GROUNDED))
    case.pass_time(0.1)
    case.supply.unproven = True
    with pytest.raises(RefusedError, match="came back"):
        case.supervisor.clear_fault()
    case.supply.unproven = False
    case.supervisor.clear_fault()
    assert case.supervisor.fault is None


@pytest.mark.parametrize("code", [FaultCode.MONITOR, FaultCode.NOT_GROUNDED, FaultCode.GROUND_NOT_PROVEN])
def test_a_stop_does_not_take_away_that_a_proof_is_needed(case, code):
    """Stopped after the fault, and cleared: without a proof it comes back."""
    case.supervisor.fail(Fault(code))
    case.supervisor.fail(Fault(FaultCode.EMERGENCY_STOP))
    case.pass_time(0.1)
    case.supply.unproven = True
    with pytest.raises(RefusedError, match="came back"):
        case.supervisor.clear_fault()


def test_a_stop_beside_a_fault_that_needs_a_proof_is_shown(case):
    """The fault stays, and both are told; a clearing that is refused takes neither away, one that is granted both."""
    case.supervisor.fail(Fault(FaultCode.NOT_GROUNDED, "2900 and 0 V"))
    case.supervisor.fail(Fault(FaultCode.EMERGENCY_STOP, "by service"))
    case.pass_time(0.1)
    for unproven in (True, False):
        told = str(case.supervisor.status().fault)
        assert case.supervisor.fault.code in (FaultCode.NOT_GROUNDED, FaultCode.GROUND_NOT_PROVEN)
        assert "besides, emergency stop: by service" in told
        case.supply.unproven = unproven
        if unproven:
            with pytest.raises(RefusedError, match="emergency stop"):
                case.supervisor.clear_fault()
    case.supervisor.clear_fault()
    assert case.supervisor.fault is None


def test_a_ripple_that_the_output_cannot_follow_is_no_blindness(case):
    """A converter cannot sink: the output stays at the peaks of what is asked for, and that is no stuck monitor."""
    case.arm()
    for step in range(300):
        asked_v = 4600.0 if step % 2 else 4000.0
        case.supply.measured_v = (min(4600.0, 250.0 * step) - (step % 4), 0.0)
        case.supervisor.command((asked_v, 0.0))
        case.pass_time(0.01)
    assert case.supervisor.fault is None
