# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`optimise`: the waveform, or the body, with which a free body swims best."""

import argparse
import importlib.util
import json
import sys
from dataclasses import asdict
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Console

from hasel_sim.errors import HaselSimError, SimulationError
from hasel_sim.model import Model, load_model
from hasel_sim.model.model_file import save_model
from hasel_sim.swimming.boxes import Boxes, waveform_rows
from hasel_sim.swimming.free_swim import FreeSwim, check_swimmer, free_swim

if TYPE_CHECKING:
    from hasel_sim.swimming.search import BestSwim


def run(options: argparse.Namespace) -> int:
    """Search, confirm on the model's own mesh and write the waveform; 0, or 1 with a sentence about what is wrong."""
    try:
        return _run(options)
    except HaselSimError as error:
        print(f"optimise: {error}", file=sys.stderr)
        return 1


def _run(options: argparse.Namespace) -> int:
    if importlib.util.find_spec("torch") is None:
        raise SimulationError("optimise needs PyTorch for its gradients: install torch")
    from hasel_sim.swimming.best_swim import best_swim
    from hasel_sim.swimming.search import Task

    model = load_model(options.model)
    model = model.with_freed(*dict(options.set)).with_values(dict(options.set))
    check_swimmer(model)
    turning, heading = (
        None if a is None else float(np.radians(a)) for a in (options.turning, options.heading)
    )
    ranges = {name: given for name, given in options.vary.items() if given}
    task = Task(
        options.goal, turning, tuple(options.vary), options.largest, options.duration, heading, ranges
    )
    first, second = options.start[0]
    start = Boxes(first, second, options.frequency, options.duty, options.phase)
    console = Console()
    draft = model.with_numerics(mesh_density=options.density)
    found = best_swim(
        draft, start, task, options.most, lambda tried: console.print(f"  {tried}", soft_wrap=True)
    )
    console.print(str(found), soft_wrap=True)
    improved = found.improved(model)
    # what it has turned by a time is a matter of that time; speed and turning settle
    duration = options.duration * (1 if heading is not None else 2)
    before = _confirmed(model, start, duration)
    after = _confirmed(improved, found.best.drive, duration)
    console.print(f"On the model's own mesh and over {duration:g} s:")
    for name, swim in (("before:", before), ("after: ", after)):
        points = np.degrees(swim.mean_heading(options.frequency))
        console.print(f"  {name} {swim} It points to {points:+.2f}°.", soft_wrap=True)
    _write(options, found, improved, console)
    if options.json:
        content = {
            "tried": [asdict(tried) for tried in found.tried],
            "drive": asdict(found.best.drive),
            "values": found.best.values,
            "before": _numbers(before, options.frequency),
            "after": _numbers(after, options.frequency),
        }
        options.json.write_text(json.dumps(content, indent=1))
    return 0


def _write(options: argparse.Namespace, found: "BestSwim", improved: Model, console: Console) -> None:
    path = options.output
    try:
        if found.best.drive != found.start.drive:
            path.write_text(waveform_rows(found.best.drive, options.play, improved.channels))
            said = f"Wrote {path}: {options.play:g} s that RunExperiment plays as its waveform_file."
            console.print(said, soft_wrap=True)
        if found.best.values:
            path = options.body
            save_model(improved, path)
            console.print(f"Wrote {path}: the model with the body that was found.", soft_wrap=True)
    except OSError as error:
        raise SimulationError(
            f"'{path}' cannot be written ({error.strerror}); name a folder that exists"
        ) from None


def _confirmed(model: Model, drive: Boxes, duration: float) -> FreeSwim:
    return free_swim(model, drive.run(model, duration), drive.frequency)


def _numbers(swim: FreeSwim, frequency: float) -> dict[str, float]:
    names = ("speed", "turning", "power", "distance", "heading", "cost_of_transport", "mass")
    return {**{name: getattr(swim, name) for name in names}, "mean_heading": swim.mean_heading(frequency)}
