"""`optimise`: the waveform with which a free body swims best."""

import argparse
import importlib.util
import json
import sys
from collections.abc import Sequence
from dataclasses import asdict

import numpy as np
from rich.console import Console

from hasel_sim.commands.parsers import optimise_parser
from hasel_sim.errors import HaselSimError, SimulationError
from hasel_sim.model import Model, load_model
from hasel_sim.swimming.boxes import Boxes
from hasel_sim.swimming.free_swim import FreeSwim, check_swimmer, free_swim


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return run(optimise_parser().parse_args(arguments))


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
    from hasel_sim.swimming.best_waveform import Task, best_waveform, waveform_rows

    model = load_model(options.model)
    model = model.with_freed(*dict(options.set)).with_values(dict(options.set))
    check_swimmer(model)
    turning = None if options.turning is None else float(np.radians(options.turning))
    task = Task(options.goal, turning, options.vary, options.largest, options.duration)
    first, second = options.start[0]
    start = Boxes(first, second, options.frequency, options.duty, options.phase)
    console = Console()
    draft = model.with_numerics(mesh_density=options.density)
    found = best_waveform(
        draft, start, task, options.most, lambda tried: console.print(f"  {tried}", soft_wrap=True)
    )
    console.print(str(found), soft_wrap=True)
    before, after = (_confirmed(model, drive, options.duration) for drive in (start, found.best.drive))
    console.print("On the model's own mesh and over twice the time:")
    console.print(f"  before: {before}\n  after:  {after}", soft_wrap=True)
    try:
        options.output.write_text(waveform_rows(found.best.drive, options.play, model.channels))
    except OSError as error:
        raise SimulationError(
            f"'{options.output}' cannot be written ({error.strerror}); name a folder that exists"
        ) from None
    if options.json:
        confirmed = {"before": _numbers(before), "after": _numbers(after)}
        content = {
            "tried": [asdict(tried) for tried in found.tried],
            "drive": asdict(found.best.drive),
            **confirmed,
        }
        options.json.write_text(json.dumps(content, indent=1))
    console.print(
        f"Wrote {options.output}: {options.play:g} s that RunExperiment plays as its waveform_file.",
        soft_wrap=True,
    )
    return 0


def _confirmed(model: Model, drive: Boxes, duration: float) -> FreeSwim:
    return free_swim(model, drive.run(model, 2 * duration), drive.frequency)


def _numbers(swim: FreeSwim) -> dict[str, float]:
    names = ("speed", "turning", "power", "distance", "heading", "cost_of_transport")
    return {name: getattr(swim, name) for name in names}


if __name__ == "__main__":
    sys.exit(main())
