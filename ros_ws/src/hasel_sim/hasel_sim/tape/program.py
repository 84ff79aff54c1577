"""Expressions as a list of operations on registers, each of which holds one number for every point and lane."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from hasel_sim.mechanics.tape_loops import WIDTH, operate
from hasel_sim.tape.expressions import OPERATIONS, Node


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
