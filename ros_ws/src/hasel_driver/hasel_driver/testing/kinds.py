# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Kinds of hardware that does not do as it is told, each injected while the driver drives, and judged by the truth."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from hasel_driver.protocol.faults import DriverError, FaultCode
from hasel_driver.protocol.limits import DISCHARGED_V, Voltages
from hasel_driver.protocol.status import Ground, Mode
from hasel_driver.testing.rig import Bench

DRIVEN_V: Voltages = (3000.0, -2000.0)  # of the broken channel, and of the other
OTHER_V: Voltages = (5000.0, -2000.0)
CHANNELS: tuple[tuple[str, ...], ...] = ((), ("lower",))  # words that choose the one to be broken
WITHIN_S = 0.5
WATCHED_S = 0.7
F = FaultCode
RESET = {F.DEVICE_RESET, F.GARBAGE_RECEIVED}  # its banner may cut a line in two
CONTACT = {F.NOT_GROUNDED, F.GROUND_NOT_PROVEN}


@dataclass(frozen=True)
class Kind:
    """What is injected, and what the driver must find within half a second of the moment when it can be seen."""

    name: str
    inject: tuple[str, ...]
    expected: frozenset[FaultCode]
    act: str = "drive"  # what follows: drive, change, ramp and disarm, disarm, stop, arm
    virtual_only: bool = False


def _kind(name: str, inject: str, codes: set[FaultCode], **options: Any) -> Kind:
    return Kind(name, tuple(inject.split()), frozenset(codes), **options)


KINDS: tuple[Kind, ...] = (
    _kind("divider off", "blind", {F.MONITOR}),
    _kind("divider says a third", "third", {F.MONITOR}),
    _kind("divider of the wrong sign", "invert", {F.MONITOR}, virtual_only=True),
    _kind("divider stuck as the voltage changes", "stick", {F.MONITOR}, act="change"),
    _kind("divider off before arming", "blind", {F.MONITOR, F.NOT_GROUNDED}, act="arm"),
    _kind("inputs no longer converted", "unconverted", RESET | {F.MONITOR}),
    _kind(
        "inputs not converted, muscle shorted", "unconverted overcurrent", RESET | {F.MONITOR, F.OVERCURRENT}
    ),
    _kind("timer interrupt off", "tickless", RESET | {F.NO_REPLY, F.NO_TELEMETRY, F.UNEXPECTED_STATE}),
    _kind("contact welded, disarmed", "weld", CONTACT, act="disarm"),
    _kind("contact welded, leaking load, disarmed", "weld leak", CONTACT, act="disarm"),
    _kind("contact welded before arming", "weld", CONTACT, act="arm"),
    _kind("contact welded before arming, leaking load", "weld leak", CONTACT, act="arm"),
    _kind("contact never closes, disarmed", "unground", CONTACT, act="disarm"),
    _kind("contact never closes before arming", "unground", CONTACT, act="arm"),
    _kind("contact never closes before arming, leaking load", "unground leak", CONTACT, act="arm"),
)
# Nothing can be found here before the next arming: no claim may be made.
UNSEEN: tuple[Kind, ...] = (
    _kind("contact never closes, ramped to 0 first", "unground", set(), act="ramp and disarm"),
    _kind("contact welded, ramped to 0 first", "weld", set(), act="ramp and disarm"),
)


@dataclass
class Trial:
    """What became of one: `found_s` after it could be seen; sentences for what must not be."""

    found_s: float | None = None
    wrong: list[str] = field(default_factory=list)


def try_kind(bench: Bench, kind: Kind, channel: int) -> Trial:
    """Inject one kind in one channel, and judge everything that the driver says by the voltages of the supply."""
    trial, rig = Trial(), bench.rig
    _prepare(bench)
    if kind.act != "arm":
        bench.arm()
        if not bench.command_until(
            lambda: bench.status().measured_v[channel] > 2900, _asked(DRIVEN_V, channel)
        ):
            trial.wrong.append(f"it did not reach its voltage: {bench.status()}")
            return trial
    for word in (*CHANNELS[channel], *kind.inject):
        rig.say(word)
    began_s = time.monotonic()
    _act(bench, kind, channel)
    _watch(bench, trial, kind, channel, began_s)
    if kind.expected:
        _judge(bench, trial, kind)
    rig.say("recover")
    return trial


def _asked(voltage_v: Voltages, channel: int) -> Voltages:
    """The first of two voltages on the channel that is broken."""
    return voltage_v if channel == 0 else (voltage_v[1], voltage_v[0])


def _prepare(bench: Bench) -> None:
    bench.rig.say("recover")
    bench.call(bench.supervisor.disarm)
    for _ in range(20):
        time.sleep(0.1)
        try:
            if bench.supervisor.fault is not None:
                bench.call(bench.supervisor.clear_fault)
            bench.await_mode(Mode.STANDBY)
            return
        except (DriverError, AssertionError):
            continue
    raise AssertionError(f"the driver did not come back to STANDBY: {bench.status()}")


def _act(bench: Bench, kind: Kind, channel: int) -> None:
    supervisor, (upper_v, lower_v) = bench.supervisor, _asked(DRIVEN_V, channel)
    if kind.act == "disarm":
        bench.call(supervisor.disarm)
    elif kind.act == "arm":
        bench.call(supervisor.arm)
    elif kind.act == "ramp and disarm":
        for share in range(20, -1, -1):
            bench.call(supervisor.command, (upper_v * share / 20, lower_v * share / 20))
            time.sleep(0.02)
        time.sleep(0.1)
        bench.call(supervisor.disarm)


def _watch(bench: Bench, trial: Trial, kind: Kind, channel: int, began_s: float) -> None:
    """Commands go on where they did; no word of grounded while there is voltage."""
    target_v = _asked(OTHER_V if kind.act == "change" else DRIVEN_V, channel)
    while time.monotonic() - began_s < WATCHED_S:
        if kind.act in ("drive", "change"):
            bench.call(bench.supervisor.command, target_v)
        before = abs(bench.rig.ask("output")[channel])
        status = bench.status()
        after = abs(bench.rig.ask("output")[channel])
        if status.ground is Ground.PROVEN and min(before, after) > DISCHARGED_V:
            trial.wrong.append(f"{status}, with {after:.0f} V")
        if bench.supervisor.fault is not None and trial.found_s is None:
            trial.found_s = time.monotonic() - began_s
        time.sleep(0.005)


def _judge(bench: Bench, trial: Trial, kind: Kind) -> None:
    fault = bench.supervisor.fault
    if fault is None or fault.code not in kind.expected:
        trial.wrong.append(
            f"{fault or 'nothing'} was found, {', '.join(sorted(c.name for c in kind.expected))} expected"
        )
    elif trial.found_s is None or trial.found_s > WITHIN_S:
        trial.wrong.append(f"it was found after {trial.found_s} s")
    if _succeeds(lambda: bench.call(bench.supervisor.arm)):
        trial.wrong.append("it was armed again")


def _succeeds(call: Callable[[], object]) -> bool:
    try:
        call()
    except DriverError:
        return False
    return True
