# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What the code says: of a faulty input, and in which sentences at all."""

import ast
import re
import warnings
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from hasel_recording import RecordingError, RecordingWarning
from hasel_sim.errors import SimulationError
from hasel_sysid.errors import SysidError
from hasel_tracker.errors import TrackerError

SAYING = ("RecordingError", "TrackerError", "SysidError", "warn", "_warn", "append")
FEWEST_WORDS = 3


def sentences(inputs: Iterable[Callable], folder: Path) -> set[str]:
    """All that is said of these inputs: errors, warnings, findings and notes, without the folder's path."""
    found: set[str] = set()
    for call in inputs:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", RecordingWarning)
            try:
                result = call()
            except (RecordingError, TrackerError, SysidError, SimulationError) as error:
                found.add(str(error))
            else:
                if isinstance(result, list):
                    found |= {str(each) for each in result if each is not None}
        found |= {str(each.message) for each in caught if each.category is RecordingWarning}
    return {re.sub(rf"{re.escape(str(folder))}/(\d+/)?", "", each) for each in found}


def templates(path: Path) -> Iterator[tuple[str, re.Pattern]]:
    """The sentences that a module can say, each as it stands there and as a pattern in which values may be anything."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Call) and ast.unparse(node.func).split(".")[-1] in SAYING:
            for argument in node.args:
                parts = _parts(argument)
                if len(re.findall(r"[a-z]{2,}", " ".join(filter(None, parts)))) >= FEWEST_WORDS:
                    shown = "".join("{}" if part is None else part for part in parts)
                    pattern = "".join(".+?" if part is None else re.escape(part) for part in parts)
                    yield shown, re.compile(pattern.removesuffix(re.escape(".")) + r"\.?")


def faults(path: Path) -> Iterator[str]:
    """The faults of the set-up that a module can name: first arguments of error() and warning()."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Call) and len(node.args) == 4 and isinstance(node.args[0], ast.Constant):
            yield str(node.args[0].value)


def _parts(node: ast.expr) -> list[str | None]:
    """The fixed pieces of a string, None for what is put in."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return [node.value]
    if isinstance(node, ast.JoinedStr):
        return [part.value if isinstance(part, ast.Constant) else None for part in node.values]
    return []
