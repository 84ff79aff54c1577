# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 run hasel_driver bench`: how fast a command, and the grounding of a dead node; what a busy machine ends."""

import argparse
import os
import sys
import time
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass

import numpy as np

from hasel_driver.protocol import wire
from hasel_driver.protocol.status import Mode
from hasel_driver.testing.rig import VIRTUAL_SUPPLY, Rig, firmware_command
from hasel_driver.testing.ros_client import DriverProcess, RosClient

LATENCY_BAR_S = 0.005
GROUNDED_BAR_S = 0.5
RATE_BAR_HZ = 250.0
PACE_HZ = 100.0
FLAT_OUT_S = 3.0
EXPERIMENT_S = 3.0
SURVIVAL_BAR = 0.98
START_S = 60.0  # of a node on a busy machine
BOARD_LATE_S = 0.1  # half of what its telemetry may be silent


def latencies(client: RosClient, rig: Rig, count: int) -> np.ndarray:
    """Time from publishing a command to its first byte on the wire [s], shape [≤ count]."""
    published_s: dict[int, float] = {}
    rig.wire.clear()
    next_s = time.monotonic()
    for number in range(1, count + 1):
        next_s += 1 / PACE_HZ
        time.sleep(max(0.0, next_s - time.monotonic()))
        published_s[number] = time.monotonic()
        client.command((float(number), 0.0))
    time.sleep(0.1)
    return np.array([time_s - published_s[upper] for time_s, upper, _ in rig.wire if upper in published_s])


def command_rate(client: RosClient, rig: Rig, duration_s: float) -> float:
    """Commands on the wire [1/s] while they are published as fast as can be.

    The driver sends one only when the board has answered those before, but for two: what is sent is obeyed.
    """
    rig.wire.clear()
    begin_s, number = time.monotonic(), 0
    while time.monotonic() - begin_s < duration_s:
        number = number % 5000 + 1
        client.command((float(number), 0.0))
        time.sleep(0.0005)
    return len(rig.wire) / (time.monotonic() - begin_s)


def grounding_times(client: RosClient, rig: Rig, count: int) -> list[float]:
    """Time from SIGKILL of the live node to a dead output [s]."""
    times_s = []
    for _ in range(count):
        driver = DriverProcess(client, rig.port)
        driver.arm()
        client.drive(lambda: rig.live)
        killed_s = time.monotonic()
        driver.process.kill()
        times_s.append(rig.await_live(False) - killed_s)
        driver.close()
    return times_s


@dataclass(frozen=True)
class EndedEarly:
    """An experiment that ended by a fault: its sentence, and by how much the simulated supply itself was late [s]."""

    fault: str
    supply_late_s: float


def ended_early(
    client: RosClient, driver: DriverProcess, late: list[tuple[float, float]], count: int
) -> list[EndedEarly]:
    """Of `count` experiments of 3 s, into which nothing is injected; `late`: when and how late the supply was [s]."""
    ended = []
    client.await_mode(Mode.STANDBY, START_S)
    for _ in range(count):
        begin_s = time.monotonic()
        try:
            _run_one(client, driver)
            fault = client.state.fault_text
        except AssertionError as error:
            fault = str(error)
        if fault:
            worst_s = max((late_s for when_s, late_s in late if when_s >= begin_s), default=0.0)
            ended.append(EndedEarly(fault.split(". ")[0], worst_s))
    return ended


def _run_one(client: RosClient, driver: DriverProcess) -> None:
    """Arm and command for 3 s, or until a fault; before it what the last one left is cleared."""
    if client.state.mode == Mode.FAULT:
        client.trigger("clear_fault")
    driver.arm()
    begin_s = time.monotonic()
    with client.commanding((1500.0, 0.0)):
        while time.monotonic() - begin_s < EXPERIMENT_S and not client.state.fault_code:
            time.sleep(0.02)
    if not client.state.fault_code:
        client.trigger("disarm")


def count_experiments(
    client: RosClient, rig: Rig, late: list[tuple[float, float]], count: int, priority: int, what: str
) -> bool:
    """Run them and print; whether nearly all came to their end, but for what a real board would not have ended."""
    problem = rig.keep_time()
    if problem is not None:
        print(
            f"The simulated board shares its time with the rest of this machine, as no real one does: {problem}."
        )
    with closing(DriverProcess(client, rig.port, realtime_priority=priority)) as driver:
        ended = ended_early(client, driver, late, count)
    board_late = [one for one in ended if one.supply_late_s > BOARD_LATE_S]
    met = len(ended) - len(board_late) <= (1 - SURVIVAL_BAR) * count
    load = os.getloadavg()[0]
    print(
        f"{what}, experiments ended by a fault: {len(ended)} of {count} at a load of {load:.0f}, {len(board_late)} of"
        f" them because the simulated board was late (bar for the others {1 - SURVIVAL_BAR:.0%}:"
        f" {'met' if met else 'MISSED'})"
    )
    for one in ended:
        print(f"  {one.fault}; the simulated board was {one.supply_late_s:.2f} s late")
    return met


def report(
    name: str, values_s: Sequence[float] | np.ndarray, bar_s: float, percentile: float
) -> tuple[str, bool]:
    """One line with median, high percentile or maximum, and the bar; and whether it is met."""
    high_s = float(np.percentile(values_s, percentile))
    label = "maximum" if percentile == 100 else f"{percentile:g}th percentile"
    met = high_s <= bar_s
    line = (
        f"{name}: median {1e3 * float(np.median(values_s)):.2f} ms, {label} {1e3 * high_s:.2f} ms"
        f" (bar {1e3 * bar_s:g} ms: {'met' if met else 'MISSED'}; n = {len(values_s)})"
    )
    return line, met


def measure(client: RosClient, rig: Rig, commands: int, kills: int, priority: int, what: str) -> bool:
    """Measure and print; whether every bar is met. `what`: the supply, in words."""
    with closing(DriverProcess(client, rig.port, realtime_priority=priority)) as driver:
        driver.arm()
        rig.say("trace")
        measured_s = latencies(client, rig, commands)
        rate_hz = command_rate(client, rig, FLAT_OUT_S)
        if not rig.live:
            raise AssertionError(
                f"the supply left the armed state while it was driven ({client.state.fault_text})"
            )
    latency, fast = report(f"{what}, command to wire", measured_s, LATENCY_BAR_S, 99)
    length = len(wire.encode_command(0, "SET", "VOLTAGE", 6000, -6000))
    often = rate_hz >= RATE_BAR_HZ
    print(
        f"{latency}; a line of {length} characters takes {10e3 * length / wire.BAUD:.1f} ms more\n"
        f"{what}, commands obeyed: {rate_hz:.0f} /s (bar {RATE_BAR_HZ:g} /s: {'met' if often else 'MISSED'})"
    )
    grounded_s = grounding_times(client, rig, kills)
    grounding, grounded = report(f"{what}, node killed to output grounded", grounded_s, GROUNDED_BAR_S, 100)
    print(grounding)
    return fast and often and grounded


def run(options: argparse.Namespace) -> int:
    """Measure with these options; 0 when every bar is met, else 1."""
    command, what = VIRTUAL_SUPPLY, "driver"
    if options.firmware is not None:
        command, what = firmware_command(options.firmware), "driver and firmware"
    late: list[tuple[float, float]] = []
    met, priority = True, options.realtime_priority
    with (
        closing(RosClient()) as client,
        closing(Rig(command, lambda late_s: late.append((time.monotonic(), late_s)))) as rig,
    ):
        try:
            if options.commands:
                met = measure(client, rig, options.commands, options.kills, priority, what)
            if options.experiments:
                met &= count_experiments(client, rig, late, options.experiments, priority, what)
        except AssertionError as failure:
            print(
                f"The measurement failed: {failure}; try again on a machine with less to do.", file=sys.stderr
            )
            return 1
    return int(not met)
