# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Faults of board, line and host, against the virtual supply and the firmware in simavr."""

import math
import os
import random
import time

import pytest
from hasel_driver.protocol import wire
from hasel_driver.protocol.faults import Fault, FaultCode, RefusedError
from hasel_driver.protocol.limits import Limits, clip
from hasel_driver.protocol.status import Mode
from hasel_driver.protocol.waveform import Waveform

LIMIT_V = Limits().maximum_voltage_v
WAVEFORM = Waveform("box", 3000.0, 0.2, 1, polarity="alternating")


def second_master(bench):
    """Another program writes a valid command to the same port."""
    descriptor = os.open(bench.rig.port, os.O_RDWR | os.O_NOCTTY)
    os.write(descriptor, wire.encode_command(random.randrange(256), "SET", "VOLTAGE", 1000, 1000))
    os.close(descriptor)


def inject(name):
    """A fault that the rig produces."""
    return lambda bench: bench.rig.say(name)


def stall(bench):
    """The node's executor hangs."""
    bench.host_alive = False


def command(*voltage):
    """A voltage that is no number."""
    return lambda bench: bench.call(bench.supervisor.command, voltage)


def emergency_stop(bench):
    """As topic and service do."""
    bench.call(bench.supervisor.fail, Fault(FaultCode.EMERGENCY_STOP))


# fault: (how, codes it may be latched as)
FAULTS = {
    "silence": (inject("silence"), {"NO_TELEMETRY", "NO_REPLY"}),
    "deaf": (inject("deaf"), {"NO_REPLY", "HEARTBEAT"}),
    "stuck": (inject("stuck"), {"NO_TELEMETRY", "NO_REPLY", "DEVICE_RESET", "GARBAGE_RECEIVED"}),
    "garbage": (inject("garbage"), {"GARBAGE_RECEIVED"}),
    "truncated line": (inject("truncate"), {"GARBAGE_RECEIVED"}),
    "garbled command": (inject("noise"), {"GARBAGE", "SEQUENCE", "TWO_MASTERS", "NO_REPLY"}),
    "reset": (inject("reset"), {"DEVICE_RESET", "GARBAGE_RECEIVED", "NO_REPLY", "UNEXPECTED_STATE"}),
    "over-current": (inject("overcurrent"), {"OVERCURRENT"}),
    "interlock": (inject("interlock"), {"INTERLOCK"}),
    "unplugged": (inject("unplug"), {"LINK_LOST"}),
    "two masters": (second_master, {"TWO_MASTERS", "SEQUENCE", "NO_REPLY", "GARBAGE_RECEIVED", "GARBAGE"}),
    "stalled node": (stall, {"HOST_STALLED"}),
    "not a number": (command(math.nan, 0.0), {"INVALID_COMMAND"}),
    "infinite": (command(1000.0, math.inf), {"INVALID_COMMAND"}),
    "emergency stop": (emergency_stop, {"EMERGENCY_STOP"}),
}


def run_waveform(bench) -> None:
    """The board generates the voltage; commands would be a second master."""
    bench.call(bench.supervisor.begin_experiment)
    bench.call(bench.supervisor.start, WAVEFORM)
    bench.rig.await_live(True)


def provoke(bench, how, codes, by_waveform, grounded_in_time) -> None:
    """One fault while live: grounded in time, latched, truthful, and nothing comes back by itself."""
    bench.statuses.clear()
    bench.arm()
    if by_waveform:
        run_waveform(bench)
    else:
        assert bench.command_until(lambda: bench.rig.live)
    time.sleep(random.uniform(0.0, 0.03))  # meet the line and the heartbeat at any phase
    at_s = time.monotonic()
    how(bench)
    if by_waveform:
        bench.wait_until(lambda: bench.supervisor.fault is not None)
    bench.command_until(lambda: bench.supervisor.fault is not None and not bench.rig.live)
    grounded_in_time(bench.rig, at_s)
    assert bench.supervisor.fault.code.name in codes, str(bench.supervisor.fault)
    bench.rig.say("recover")
    bench.host_alive = True
    bench.command_until(lambda: False, timeout_s=0.1)
    assert not bench.rig.live
    assert bench.status().mode is Mode.FAULT
    with pytest.raises(RefusedError):
        bench.call(bench.supervisor.arm)
    assert bench.false_claims() == []


@pytest.mark.rounds(4, 50)
@pytest.mark.parametrize("name", FAULTS)
def test_grounds_latches_and_does_not_rearm(bench, name, rounds, grounded_in_time):
    """Every fault, under commands and under a waveform: grounded within 500 ms, FAULT until cleared by hand."""
    for index in range(rounds):
        provoke(bench, *FAULTS[name], index % 2 == 1, grounded_in_time)
        if name == "unplugged":
            bench.rig.replug()
            bench.port.path = bench.rig.port
        bench.call(bench.supervisor.clear_fault)


@pytest.mark.rounds(20, 1000)
def test_nothing_above_the_limit_reaches_the_wire(bench, rounds):
    """Whatever finite voltage is asked for: on the wire, in the reports and on the output it is within the limit."""
    bench.rig.say("trace")
    bench.arm()
    for _ in range(rounds):
        asked = tuple(random.choice((-1, 1)) * 10 ** random.uniform(2.0, 12.0) for _ in range(2))
        expected = clip(asked, LIMIT_V)
        assert bench.command_until(lambda e=expected: follows(bench.status(), e), asked)
    bench.call(bench.supervisor.disarm)
    sent = {abs(voltage) for _, *voltages in bench.rig.wire for voltage in voltages}
    assert max(sent) == LIMIT_V
    assert max(bench.rig.ask("output")[4:]) < LIMIT_V * 1.02


def follows(status, expected) -> bool:
    """Whether `expected` is what the board reports as asked of it, rounded to volts."""
    return status.commanded_v == tuple(map(round, expected))
