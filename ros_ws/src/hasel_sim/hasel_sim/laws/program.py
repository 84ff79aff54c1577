# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Expressions as a list of operations on registers, each of which holds one number for every point and lane.

The compiled loop `operate` does them: a register is WIDTH numbers in a row, and the loop over them is what the
processor does in vectors.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numba import njit

from hasel_sim.laws.expressions import OPERATIONS, Node

WIDTH = 128
"""Numbers of a register: enough that finding out what to do is nothing beside doing it, few enough for the cache."""


@njit(cache=True, fastmath={"contract", "nsz"}, error_model="numpy")
def operate(operations: np.ndarray, first: int, last: int, registers: np.ndarray) -> None:
    """Do the operations [n, 5] from the first until before the last on the registers [n, WIDTH]."""
    for n in range(first, last):
        what, out = operations[n, 0], registers[operations[n, 1]]
        a, b, c = registers[operations[n, 2]], registers[operations[n, 3]], registers[operations[n, 4]]
        if what == 0:
            for i in range(WIDTH):
                out[i] = a[i] + b[i]
        elif what == 1:
            for i in range(WIDTH):
                out[i] = a[i] - b[i]
        elif what == 2:
            for i in range(WIDTH):
                out[i] = a[i] * b[i]
        elif what == 3:
            for i in range(WIDTH):
                out[i] = a[i] / b[i]
        elif what == 4:
            for i in range(WIDTH):
                divisor = b[i]
                zero = divisor == 0.0
                out[i] = (0.0 if zero else a[i]) / (1.0 if zero else divisor)
        elif what == 5:
            for i in range(WIDTH):
                out[i] = -a[i]
        elif what == 6:
            for i in range(WIDTH):
                out[i] = abs(a[i])
        elif what == 7:
            for i in range(WIDTH):
                out[i] = (1.0 if a[i] > 0.0 else 0.0) - (1.0 if a[i] < 0.0 else 0.0)
        elif what == 8:
            for i in range(WIDTH):
                out[i] = math.sqrt(a[i])
        elif what == 9:
            for i in range(WIDTH):
                out[i] = a[i] ** b[i]
        elif what == 10:
            for i in range(WIDTH):
                out[i] = math.exp(a[i])
        elif what == 11:
            for i in range(WIDTH):
                out[i] = math.expm1(a[i])
        elif what == 12:
            for i in range(WIDTH):
                out[i] = np.log(a[i])
        elif what == 13:
            for i in range(WIDTH):
                out[i] = np.log1p(a[i])
        elif what == 14:
            for i in range(WIDTH):
                out[i] = math.sin(a[i])
        elif what == 15:
            for i in range(WIDTH):
                out[i] = math.cos(a[i])
        elif what == 16:
            for i in range(WIDTH):
                out[i] = np.arcsin(a[i])
        elif what == 17:
            for i in range(WIDTH):
                out[i] = np.arccos(a[i])
        elif what == 18:
            for i in range(WIDTH):
                out[i] = math.atan(a[i])
        elif what == 19:
            for i in range(WIDTH):
                out[i] = math.atan2(a[i], b[i])
        elif what == 20:
            for i in range(WIDTH):
                out[i] = math.sinh(a[i])
        elif what == 21:
            for i in range(WIDTH):
                out[i] = math.cosh(a[i])
        elif what == 22:
            for i in range(WIDTH):
                out[i] = math.tanh(a[i])
        elif what == 23:
            for i in range(WIDTH):
                out[i] = a[i] if a[i] >= b[i] else b[i]
        elif what == 24:
            for i in range(WIDTH):
                out[i] = a[i] if a[i] <= b[i] else b[i]
        elif what == 25:
            for i in range(WIDTH):
                out[i] = 1.0 if a[i] > b[i] else 0.0
        elif what == 26:
            for i in range(WIDTH):
                out[i] = 1.0 if a[i] >= b[i] else 0.0
        elif what == 27:
            for i in range(WIDTH):
                out[i] = 1.0 if a[i] == b[i] else 0.0
        elif what == 28:
            for i in range(WIDTH):
                out[i] = b[i] if a[i] != 0.0 else c[i]


class Program:
    """What computes some outputs; everything that is the same at all points is computed once, before the points.

    inputs: (name, register) of what differs from point to point; uniform: the same of what does not, (None, value)
    being a constant; before, operations: [n, 5], number in `OPERATIONS`, result, up to three operands; outputs: (row,
    register); registers: how many there are.
    """

    def __init__(self, outputs: Sequence[tuple[int, Node]], is_uniform: Callable[[Any], bool]) -> None:
        outputs = [(row, node) for row, node in outputs if not node.is_constant(0.0)]
        nodes, last_use = _needed([node for _, node in outputs])
        self.inputs: list[tuple[Any, int]] = []
        self.uniform: list[tuple[Any, int]] = []
        self.registers = 0
        self._free: list[int] = []
        before: list[list[int]] = []
        operations: list[list[int]] = []
        register: dict[Node, int] = {}
        same: dict[Node, bool] = {}
        for node in nodes:
            same[node] = node.operation == "constant" or (
                is_uniform(node.value) if node.operation == "input" else all(same[x] for x in node.operands)
            )
        for node in sorted(nodes, key=lambda node: (not same[node], bool(node.operands), node.place)):
            register[node] = self._new() if same[node] or not self._free else self._free.pop()
            if node.operation == "constant":
                self.uniform.append(((None, node.value), register[node]))
            elif node.operation == "input":
                (self.uniform if same[node] else self.inputs).append((node.value, register[node]))
            else:
                places = [register[x] for x in node.operands]
                row = [
                    OPERATIONS.index(node.operation),
                    register[node],
                    *places,
                    *[places[-1]] * (3 - len(places)),
                ]
                (before if same[node] else operations).append(row)
                if not same[node]:
                    done = [x for x in set(node.operands) if last_use[x] is node and not same[x]]
                    self._free += [register[x] for x in done]
        self.outputs = [(row, register[node]) for row, node in outputs]
        self.before, self.operations = (
            np.array(rows, dtype=np.intp).reshape(-1, 5) for rows in (before, operations)
        )

    def _new(self) -> int:
        self.registers += 1
        return self.registers - 1

    def same_but_for_constants(self, other: "Program") -> bool:
        """Whether another one does the same with other constants."""
        pairs = ((self.before, other.before), (self.operations, other.operations))
        names = [[name if name[0] is not None else None for name, _ in x.uniform] for x in (self, other)]
        same = self.inputs == other.inputs and self.outputs == other.outputs and names[0] == names[1]
        return same and all(np.array_equal(*pair) for pair in pairs)

    def run(self, given: Callable[[Any], np.ndarray | float], points: int, rows: int) -> np.ndarray:
        """The outputs [rows, points], zero where there is none; given: what a name stands for, [points] or a number."""
        padded = -(-points // WIDTH) * WIDTH
        found, values = np.zeros((rows, points)), np.zeros((self.registers, padded))
        for name, register in [*self.inputs, *self.uniform]:
            constant = isinstance(name, tuple) and name[0] is None
            values[register, :points] = name[1] if constant else given(name)
            values[register, points:] = values[register, 0]
        for first in range(0, padded, WIDTH):
            part = np.ascontiguousarray(values[:, first : first + WIDTH])
            operate(self.before, 0, len(self.before), part)
            operate(self.operations, 0, len(self.operations), part)
            values[:, first : first + WIDTH] = part
        for row, register in self.outputs:
            found[row] = values[register, :points]
        return found


def _needed(outputs: Sequence[Node]) -> tuple[list[Node], dict[Node, Node | None]]:
    """What the outputs are made of, every node behind its operands, and what uses each last (None: it is an output)."""
    last_use: dict[Node, Node | None] = {}
    waiting, seen = list(outputs), set(outputs)
    while waiting:
        for operand in waiting.pop().operands:
            if operand not in seen:
                seen.add(operand)
                waiting.append(operand)
    nodes = sorted(seen, key=lambda node: node.place)
    for node in nodes:
        for operand in node.operands:
            last_use[operand] = node
    return nodes, {node: None if node in set(outputs) else last_use.get(node) for node in nodes}
