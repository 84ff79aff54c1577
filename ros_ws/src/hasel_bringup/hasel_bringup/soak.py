# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`make soak`: the virtual rig for ten minutes, each node killed and started again in the middle."""

import argparse
import os
import time
from collections import defaultdict
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import psutil
from hasel_common.endpoints import Role, subscription
from hasel_common.topics import ERROR, MEASURED, SIMULATED, STATE
from hasel_recording.ros_messages import nanoseconds
from hasel_sysid.live.sysid_parameters import PARAMETERS

from hasel_bringup.experimenter import Experimenter
from hasel_bringup.processes import ALONE, OWN_DOMAIN, Processes
from hasel_bringup.recorder import RECORDED

NODES = {
    "virtual_supply": ("hasel_driver", "--link", "{folder}/port"),
    "driver_node": (
        "hasel_driver", "--ros-args", "-p", "port:={folder}/port", "-p", "history_file:={folder}/history.jsonl",
        "-p", "state_folder:={folder}/state",
    ),
    "virtual_rig": ("hasel_bringup", "--body-only"),
    "simulator": ("hasel_sim",),
    "sysid": ("hasel_sysid",),
    "recorder": ("hasel_bringup", "--ros-args", "-p", "folder:={folder}/recordings"),
}  # fmt: skip
KILLED = ("simulator", "sysid", "virtual_rig", "driver_node")
MOST_GROWTH = 0.05  # of a process's memory, from the first to the last fifth of its life
GAP_S = next(p.default for p in PARAMETERS if p.name == "gap")  # of sysid
FRAME_RATE = 120.0  # of the virtual camera
MOST_OFF = 0.005  # of the frame rate
_RECOVERY_S = 60.0
_MEMORY_PERIOD_S = 5.0


class Soak:
    """Counts everything between two kills; `problems` says what was not as it should be."""

    def __init__(self, folder: Path, seconds: float) -> None:
        self._folder, self._seconds = folder, seconds
        os.environ.update(ALONE)
        self._processes = Processes(folder, ALONE)
        self._stamps: dict[str, list[int]] = defaultdict(list)
        self._memory: dict[str, list[tuple[float, float]]] = defaultdict(list)
        self.problems: list[str] = []

    def run(self) -> None:
        """Start, watch for half the time, kill one after the other, watch for the other half."""
        with self._processes:
            for name in NODES:
                self._start(name)
            self._rig = Experimenter(self._processes.check, OWN_DOMAIN)
            try:
                for topic, kind in RECORDED.items():
                    subscription(self._rig.node, kind, topic, self._note(topic), Role.EVERY_SAMPLE)
                self._until_all_speak("the start")
                self._watch("the first half", self._seconds / 2)
                for name in KILLED:
                    self._kill(name)
                self._watch("the second half", self._seconds / 2)
                self._judge_memory()
            finally:
                self._rig.close()

    def _start(self, name: str) -> None:
        package, *words = NODES[name]
        self._processes.start(package, name, *(word.format(folder=self._folder) for word in words))

    def _note(self, topic: str) -> Callable[[Any], None]:
        stamps = self._stamps[topic]
        return lambda message: stamps.append(nanoseconds(message.header.stamp))

    def _until_all_speak(self, when: str) -> float:
        """Forget what was heard and wait until every topic speaks again; how long that took [s]."""
        begun = time.monotonic()
        for stamps in self._stamps.values():
            stamps.clear()
        self._rig.until(
            lambda: all(len(stamps) > 5 for stamps in self._stamps.values()),
            _RECOVERY_S,
            f"not everybody spoke after {when}",
        )
        return time.monotonic() - begun

    def _watch(self, when: str, seconds: float) -> None:
        """Count for some time: rates by the stamps, and whether each measured angle met its simulated one."""
        self._rig.pause(2.0)
        for stamps in self._stamps.values():
            stamps.clear()
        begun = time.monotonic()
        before = {name: self._used(name) for name in NODES}
        end = begun + seconds
        while time.monotonic() < end:
            self._rig.pause(min(_MEMORY_PERIOD_S, max(0.0, end - time.monotonic())))
            for name in NODES:
                self._memory[name].append((time.monotonic(), self._used(name)[1]))
        self._tell_cost(when, before, time.monotonic() - begun)
        heard = {topic: np.array(stamps) for topic, stamps in self._stamps.items()}
        # What was under way at either end of the watch is no loss.
        first = max(stamps[0] for stamps in heard.values()) + 500_000_000
        last = min(stamps[-1] for stamps in heard.values()) - 500_000_000
        within = {topic: s[(s >= first) & (s <= last)] for topic, s in heard.items()}
        span_s = (last - first) * 1e-9
        counts = {topic: len(stamps) for topic, stamps in within.items()}
        rates = ", ".join(f"{topic} {count} ({count / span_s:.1f}/s)" for topic, count in counts.items())
        print(f"{when}: {span_s:.0f} s, {rates}", flush=True)
        self._compare(when, "states without a simulated angle", within[STATE], within[SIMULATED])
        compared = between_states(within[MEASURED], heard[STATE], GAP_S)
        print(f"{when}: {np.sum(~compared)} measured angles while states were more than {GAP_S:g} s apart")
        self._compare(
            when, "other measured angles without an error", within[MEASURED][compared], within[ERROR]
        )
        gaps = np.diff(within[STATE]) * 1e-9
        print(f"{when}: longest distance of two states {gaps.max():.3f} s, median {np.median(gaps):.4f} s")
        rate = counts[MEASURED] / span_s
        if abs(rate / FRAME_RATE - 1) > MOST_OFF:
            self.problems.append(f"{when}: {rate:.2f} measured angles a second, expected {FRAME_RATE:g}")

    def _compare(self, when: str, what: str, sent: np.ndarray, answered: np.ndarray) -> None:
        missing = len(np.setdiff1d(sent, answered))
        print(f"{when}: {missing} {what}, of {len(sent)}")
        if missing:
            self.problems.append(f"{when}: {missing} {what}")

    def _kill(self, name: str) -> None:
        others = {each: self._processes.process_id(each) for each in NODES if each != name}
        self._processes.kill(name)
        self._start(name)
        took = self._until_all_speak(f"{name} was killed")
        print(f"{name} killed and started again: everybody speaks after {took:.1f} s", flush=True)
        if others != {each: self._processes.process_id(each) for each in others}:
            self.problems.append(f"another node ended when {name} was killed")
        self._memory[name].clear()

    def _used(self, name: str) -> tuple[float, float]:
        """Processor time [s] so far and memory [MB] of a node and of what it started; shared pages count in parts."""
        node = psutil.Process(self._processes.process_id(name))
        seconds, memory = 0.0, 0.0
        for process in (node, *node.children(recursive=True)):
            with suppress(psutil.NoSuchProcess):
                times = process.cpu_times()
                seconds += times.user + times.system
                memory += process.memory_full_info().pss / 1e6
        return seconds, memory

    def _tell_cost(self, when: str, before: dict[str, tuple[float, float]], seconds: float) -> None:
        """Of all nodes while nothing is driven."""
        now = {name: self._used(name) for name in NODES}
        cores = {name: (used - before[name][0]) / seconds for name, (used, _) in now.items()}
        each = ", ".join(f"{name} {cores[name]:.2f}" for name in NODES)
        memory = sum(used for _, used in now.values())
        print(f"{when}, at rest: {sum(cores.values()):.2f} cores ({each}), {memory:.0f} MB", flush=True)

    def _judge_memory(self) -> None:
        for name, samples in self._memory.items():
            values = np.array([value for _, value in samples])
            fifth = max(1, len(values) // 5)
            before, after = np.median(values[fifth : 2 * fifth]), np.median(values[-fifth:])
            print(f"{name}: {before:.1f} MB, at the end {after:.1f} MB")
            if after > before * (1 + MOST_GROWTH):
                self.problems.append(f"{name} grew from {before:.1f} to {after:.1f} MB")


def between_states(frames: np.ndarray, states: np.ndarray, gap: float) -> np.ndarray:
    """Whether each frame [ns] [n] lies between two states [ns] no further apart than `gap` [s]; on a state, it does.

    The simulated angle is not interpolated where states are missing.
    """
    after = np.clip(np.searchsorted(states, frames), 1, len(states) - 1)
    near = states[after] - states[after - 1] <= gap * 1e9
    return np.isin(frames, states) | (near & (states[after - 1] < frames) & (frames < states[after]))


def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code, 1 when something was not as it should be."""
    soak = Soak(options.output.resolve(), 60.0 * options.minutes)
    try:
        soak.run()
    except KeyboardInterrupt:
        return 0
    for problem in soak.problems:
        print(f"not as it should be: {problem}")
    return 1 if soak.problems else 0
