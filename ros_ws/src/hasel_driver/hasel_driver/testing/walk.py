# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A random walk over everything that can be done to a driver and its hardware, judged by the supply's voltages."""

import random
import time
from collections.abc import Callable

from hasel_driver.protocol.faults import DriverError, Fault, FaultCode
from hasel_driver.protocol.limits import DISCHARGED_V
from hasel_driver.protocol.status import Ground
from hasel_driver.testing.kinds import WITHIN_S
from hasel_driver.testing.rig import Bench

MOST_V = 6000.0
LONGEST_S = 0.8  # of one act
PROOF_S = 0.3  # of arming
PERIOD_S = 0.01
NO_GROUND = {"weld", "unground"}  # with which nothing can ground the output
WORDS = (
    "lower",  # the channel that is broken from then on
    *NO_GROUND,
    *("blind", "third", "stick", "unconverted", "leak", "overcurrent", "tickless"),
    *("interlock", "interlock_a", "interlock_b", "bounce"),
    *("silence", "deaf", "stuck", "noise", "garbage", "truncate", "reset", "mute_reset"),
)


class Walk:
    """`wrong` collects sentences; `log` the acts, with their times [s]; `live` of `looks` saw voltage."""

    def __init__(self, bench: Bench, seed: int) -> None:
        self._bench, self._random = bench, random.Random(seed)
        self._began_s = time.monotonic()
        self._broken: set[str] = set()
        self._ground_whole_s = self._began_s  # since when the output could be grounded
        self._stopped_s: float | None = None  # when it was last asked for, or a fault was found
        self.log: list[str] = []
        self.wrong: list[str] = []
        self.looks = self.live = 0

    def run(self, duration_s: float) -> None:
        """Act at random for so long, then mend everything."""
        supervisor = self._bench.supervisor
        acts: dict[str, Callable[[], object]] = {
            "arm": supervisor.arm,
            "disarm": supervisor.disarm,
            "stop": lambda: supervisor.fail(Fault(FaultCode.EMERGENCY_STOP, "by the walk")),
            "clear": supervisor.clear_fault,
            "command 0": lambda: supervisor.command((0.0, 0.0)),
        }
        while time.monotonic() - self._began_s < duration_s:
            chance = self._random.random()
            if chance < 0.15:
                self._inject("recover")
            elif chance < 0.4:
                self._inject(self._random.choice(WORDS))
            elif chance < 0.6:
                self._do(*self._random.choice(list(acts.items())))
            else:
                for name in ("clear", "arm", "command 0"):  # each refused where it is not due
                    self._do(name, acts[name])
                    self._look(PROOF_S if name == "arm" else 0.0)
                self._drive()
            self._look(self._random.uniform(0.0, LONGEST_S / 2))
        self._inject("recover")

    def _note(self, act: str) -> None:
        self.log.append(f"{time.monotonic() - self._began_s:.2f} {act}")

    def _inject(self, word: str) -> None:
        self._note(word)
        self._bench.rig.say(word)
        if word == "recover":
            self._ground_whole_s = time.monotonic() if self._broken & NO_GROUND else self._ground_whole_s
            self._broken.clear()
        else:
            self._broken.add(word)

    def _do(self, name: str, act: Callable[[], object]) -> None:
        self._note(name)
        try:
            self._bench.call(act)
        except DriverError:
            return
        if name in ("disarm", "stop") and self._stopped_s is None:
            self._stopped_s = time.monotonic()
        elif name == "arm":
            self._stopped_s = None

    def _drive(self) -> None:
        voltage_v = (self._random.uniform(-MOST_V, MOST_V), self._random.uniform(-MOST_V, MOST_V))
        self._note(f"command {voltage_v[0]:.0f} {voltage_v[1]:.0f}")
        end_s = time.monotonic() + self._random.uniform(0.0, LONGEST_S)
        while time.monotonic() < end_s:
            self._bench.call(self._bench.supervisor.command, voltage_v)
            self._look(PERIOD_S)

    def _look(self, duration_s: float) -> None:
        """For so long: no word of grounded above 200 V, and nothing live half a second after a stop or a fault."""
        bench, end_s = self._bench, time.monotonic() + duration_s
        while True:
            before_v = max(map(abs, bench.rig.ask("output")[:2]))
            status = bench.status()
            after_v = max(map(abs, bench.rig.ask("output")[:2]))
            self.looks += 1
            self.live += after_v > DISCHARGED_V
            if status.ground is Ground.PROVEN and min(before_v, after_v) > DISCHARGED_V:
                self._accuse(f"{status}, with {after_v:.0f} V")
            if bench.supervisor.fault is None and bench.supervisor.armed:
                self._stopped_s = None
            elif self._stopped_s is None:
                self._stopped_s = time.monotonic()
            self._check_dead(after_v)
            if time.monotonic() >= end_s:
                return
            time.sleep(PERIOD_S)

    def _check_dead(self, after_v: float) -> None:
        if self._stopped_s is None or self._broken & NO_GROUND:
            return
        since_s = time.monotonic() - max(self._stopped_s, self._ground_whole_s)
        if since_s > WITHIN_S and after_v > DISCHARGED_V:
            self._accuse(f"{after_v:.0f} V {since_s:.2f} s after the last chance to stop")

    def _accuse(self, text: str) -> None:
        if not self.wrong or self.wrong[-1] != text:
            self.wrong.append(text)
            self._note(f"WRONG: {text}")
