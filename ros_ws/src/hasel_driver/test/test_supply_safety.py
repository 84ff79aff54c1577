# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What the driver's thread must notice about a board: lost ground, a silent reset, a limit that was lowered."""

import time

import pytest
from hasel_driver.protocol.faults import FaultCode, RefusedError
from hasel_driver.protocol.limits import Limits
from hasel_driver.protocol.status import Mode
from hasel_driver.testing.hooks import PUNCTUALITY
from hasel_driver.testing.rig import VIRTUAL_SUPPLY, Bench, Rig


@pytest.mark.parametrize("how", ["weld", "unground"])
def test_disarming_a_charged_output_is_a_fault(bench, how):
    """With a contact that does not do as it is told: FAULT, never STANDBY for good, no arming, no false claim."""
    bench.arm()
    assert bench.command_until(lambda: bench.status().measured_v[0] > 2500)
    bench.rig.say(how)
    bench.call(bench.supervisor.disarm)
    assert bench.wait_until(lambda: bench.supervisor.fault is not None)
    assert bench.supervisor.fault.code in (FaultCode.NOT_GROUNDED, FaultCode.GROUND_NOT_PROVEN)
    assert (bench.status().mode, bench.status().quiet, bench.rig.live) == (Mode.FAULT, False, True)
    with pytest.raises(RefusedError):
        bench.call(bench.supervisor.clear_fault)
    with pytest.raises(RefusedError):
        bench.call(bench.supervisor.arm)
    assert bench.false_claims() == []


def test_a_reset_without_a_banner_is_noticed(bench):
    """The board's clock, its limits or a report cut in two tell it: FAULT, and no old limit is taken for granted."""
    bench.arm()
    bench.rig.say("mute_reset")
    assert bench.wait_until(lambda: bench.supervisor.fault is not None)
    assert bench.supervisor.fault.code in (
        FaultCode.DEVICE_RESET,
        FaultCode.UNEXPECTED_STATE,
        FaultCode.GARBAGE_RECEIVED,
    )
    bench.call(bench.supervisor.clear_fault)
    bench.await_mode(Mode.STANDBY)


def test_a_dead_tick_is_grounded_though_the_driver_goes_on(bench, grounded_in_time):
    """The watchdog resets the board, and the driver tells."""
    bench.arm()
    assert bench.command_until(lambda: bench.rig.live)
    dead_s = time.monotonic()
    bench.rig.say("tickless")
    bench.command_until(lambda: not bench.rig.live)
    grounded_in_time(bench.rig, dead_s)
    assert bench.wait_until(lambda: bench.supervisor.fault is not None)
    bench.rig.say("recover")


def test_the_limit_is_lowered_while_driven(bench):
    """The output follows, the board stays ACTIVE, and the limit cannot be raised again."""
    bench.arm()
    assert bench.command_until(lambda: bench.status().measured_v[0] > 4500, (5000.0, 0.0))
    bench.call(bench.supervisor.lower_maximum, 2000.0)

    def lowered() -> bool:
        status = bench.status()
        return status.commanded_v == (2000.0, 0.0) and 1900 < status.measured_v[0] < 2100

    assert bench.command_until(lowered, (5000.0, 0.0))
    assert not bench.command_until(lambda: bench.supervisor.fault is not None, (5000.0, 0.0), 0.4)
    with pytest.raises(RefusedError, match="only be lowered"):
        bench.call(bench.supervisor.lower_maximum, 3000.0)


def test_a_command_that_expires_does_not_wait_for_the_slew_limit(rig):
    """However gentle the slew: grounded within half a second of the last command, and still armed."""
    bench = Bench(rig, Limits(slew_v_per_ms=10.0))
    try:
        bench.arm()
        assert bench.command_until(lambda: bench.status().measured_v[0] > 2500, timeout_s=4.0)
        last_s = time.monotonic()
        assert rig.await_live(False) - last_s < 0.5
        bench.await_mode(Mode.ARMED)
    finally:
        bench.close()


@pytest.fixture(params=["virtual", "firmware"])
def loaded_rig(request):
    """A function that starts each kind of supply with muscles of a capacitance [nF]."""
    rigs = []

    def start(capacitance_nf: float) -> Rig:
        if request.param == "virtual":
            command = [*VIRTUAL_SUPPLY, "--capacitance-nf", str(capacitance_nf)]
        else:
            command = [*request.getfixturevalue("firmware_command"), str(capacitance_nf)]
        rigs.append(Rig(command, PUNCTUALITY.note))
        return rigs[-1]

    yield start
    for rig in rigs:
        rig.close()


def test_the_default_limits_fit_the_readmes_muscles(loaded_rig):
    """1.5 nF are driven to the limit and reversed without a trip."""
    bench = Bench(loaded_rig(1.5))
    try:
        bench.arm()
        for sign in (1, -1, 1):
            target_v = sign * 6000.0
            assert bench.command_until(
                lambda t=target_v: bench.status().measured_v[0] == pytest.approx(t, abs=100), (target_v, 0.0)
            ), bench.status()
    finally:
        bench.close()


def test_a_trip_by_charging_says_what_to_change(loaded_rig):
    """More than the limits allow: OVERCURRENT, with the capacitance that would fit and the parameter to lower."""
    bench = Bench(loaded_rig(4.0))
    try:
        bench.arm()
        bench.command_until(lambda: bench.supervisor.fault is not None, (6000.0, 0.0))
        assert bench.supervisor.fault.code is FaultCode.OVERCURRENT
        assert "1.8 nF" in str(bench.supervisor.fault)
        assert "lower slew_rate" in str(bench.supervisor.fault)
    finally:
        bench.close()


@pytest.mark.rounds(1, 10)
def test_a_gap_in_the_telemetry_at_rest_passes(bench, rounds):
    """A line that falls silent, cut wherever, and comes back: no fault, no claim meanwhile, and armed at once."""
    for _ in range(rounds):
        bench.await_mode(Mode.STANDBY)
        bench.rig.say("silence")
        assert bench.wait_until(lambda: bench.status().silent_s > 0.5)
        assert bench.status().output == "unknown"
        bench.rig.say("recover")
        assert bench.wait_until(lambda: not bench.status().silent_s)
        assert bench.supervisor.fault is None
        bench.arm()
        bench.call(bench.supervisor.disarm)
