# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Speed of this version against another checkout's, in turns: a ratio in one run, whatever the machine is doing."""

import json
import os
import subprocess
import sys
from contextlib import ExitStack, closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

import hasel_sim
from hasel_sim.errors import HaselSimError

ROUNDS = 7
WORKS = {
    "forward": "one run",
    "sensitivities": "one run with all sensitivities",
    "many": "four runs",
    "many_sensitivities": "four runs with all sensitivities",
}

_TIMED = """
import itertools, json, sys, time, warnings
warnings.simplefilter("ignore")
from hasel_sim import simulate as simulating
from hasel_sim.bench.cases import box_run, fitted_swimmer, node_count

model = fitted_swimmer()
names = list(model.parameters)
cases = [(model, box_run(0.5, *drive)) for drive in itertools.product((5500.0, 4500.0), (2.0, 3.5))]

def many(names):
    if hasattr(simulating, "simulate_many"):
        return simulating.simulate_many(cases, names)
    return [simulating.simulate(*case, names) for case in cases]

works = {
    "forward": lambda: simulating.simulate(*cases[0]),
    "sensitivities": lambda: simulating.simulate(*cases[0], names),
    "many": lambda: many([]),
    "many_sensitivities": lambda: many(names),
}
for work in works.values():
    work()
print(json.dumps({"nodes": node_count(model)}), flush=True)
for _ in sys.stdin:
    took = {}
    for name, work in works.items():
        calls, start = 0, time.process_time()
        while time.process_time() - start < 0.3:
            work()
            calls += 1
        took[name] = (time.process_time() - start) / calls
    print(json.dumps(took), flush=True)
"""
"""Read by versions without `simulate_many` too: what they have no lanes for, they do one after the other."""


class _Version:
    """A process with one version of the simulator, timed when it is asked."""

    def __init__(self, folder: Path) -> None:
        path = os.pathsep.join(filter(None, (str(folder), os.environ.get("PYTHONPATH"))))
        environment = {**os.environ, "PYTHONPATH": path, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
        self._folder = folder
        self._process = subprocess.Popen(
            [sys.executable, "-c", _TIMED],
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self.nodes = int(self._answer()["nodes"])

    def seconds(self) -> dict[str, float]:
        """Processor time [s] of one call of every work."""
        self._process.stdin.write("again\n")
        self._process.stdin.flush()
        return self._answer()

    def _answer(self) -> dict[str, float]:
        line = self._process.stdout.readline()
        if not line:
            raise HaselSimError(
                f"The simulator in {self._folder} could not be timed; its own words are above."
            )
        return json.loads(line)

    def close(self) -> None:
        """Let the process end."""
        self._process.stdin.close()
        self._process.wait()


@dataclass(frozen=True)
class InTurns:
    """Processor time [s] of the default swimmer on its default mesh, in the other version and in this one, by work."""

    nodes: tuple[int, int]
    other: dict[str, float]
    own: dict[str, float]

    @property
    def ratios(self) -> dict[str, float]:
        """How many times less this version takes."""
        return {name: self.other[name] / self.own[name] for name in self.own}

    def values(self) -> dict[str, Any]:
        """For JSON."""
        return {"nodes": self.nodes, "other_s": self.other, "own_s": self.own, "ratios": self.ratios}

    def print(self, console: Console) -> None:
        """The table."""
        table = Table("0.5 s of motion", "there, ms", "here, ms", "times less")
        for name, ratio in self.ratios.items():
            row = f"{1e3 * self.other[name]:.1f}", f"{1e3 * self.own[name]:.1f}", f"{ratio:.2f}"
            table.add_row(WORKS[name], *row)
        console.print(f"Default mesh: {self.nodes[0]} nodes there, {self.nodes[1]} here.")
        console.print(table)


def measure_in_turns(checkout: Path) -> InTurns:
    """Time another version of the simulator and this one in turns, each in a process of its own.

    checkout: a clone of this repository at another revision, or the folder that holds its package `hasel_sim`. Raises
    HaselSimError where there is none, or where it cannot be timed.
    """
    folders = _package_folder(checkout), Path(hasel_sim.__file__).parents[1]
    with ExitStack() as until_all_is_timed:
        versions = [until_all_is_timed.enter_context(closing(_Version(folder))) for folder in folders]
        rounds = [[version.seconds() for version in versions] for _ in range(ROUNDS)]
    other, own = (
        {name: float(np.median([one[place][name] for one in rounds])) for name in WORKS} for place in (0, 1)
    )
    return InTurns((versions[0].nodes, versions[1].nodes), other, own)


def _package_folder(checkout: Path) -> Path:
    for folder in (checkout / "ros_ws" / "src" / "hasel_sim", checkout):
        if (folder / "hasel_sim" / "__init__.py").is_file():
            return folder.resolve()
    raise HaselSimError(
        f"There is no simulator in {checkout}; give a clone of this repository at the revision to compare with."
    )
