# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`swim`: how fast a free body swims, by voltage and frequency."""

import argparse
import json
import sys
from concurrent.futures import Executor
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from hasel_common.progress import counted
from rich.console import Console
from rich.table import Column, Table

from hasel_sim.errors import HaselSimError
from hasel_sim.mesh_picture import save_picture
from hasel_sim.model import Model, load_model
from hasel_sim.parallel import executor
from hasel_sim.swimming.boxes import Boxes
from hasel_sim.swimming.sweep import (
    Optimum,
    Swam,
    SweepLedger,
    check_drives,
    draw_speeds,
    fingerprint,
    optimum,
    standard_error_of,
    sweep,
    swim_together,
)


@dataclass(frozen=True)
class Swept:
    """The swims of one model: a curve and an optimum per pair of voltages, by what the pair is called."""

    model: Model
    curves: dict[str, list[Swam]]
    optima: dict[str, Optimum | None]


def run(options: argparse.Namespace) -> int:
    """Swim, print and draw; 0, or 1 with a sentence about what is wrong; Ctrl-C leaves what was done so far."""
    try:
        return _run(options)
    except HaselSimError as error:
        print(f"swim: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print(
            f"swim: interrupted; what was done is in {options.output}, the same command goes on",
            file=sys.stderr,
        )
        return 130


def _run(options: argparse.Namespace) -> int:
    model = _model(load_model(options.model), dict(options.set))
    console = Console()
    with executor(options.jobs, options.scheduler) as pool:
        swept = _sweep(pool, model, options, "swim")
        _print(console, swept)
        varied = {name: _vary(pool, model, name, values, options) for name, values in options.free}
    for name, sweeps in varied.items():
        _print_varied(console, name, sweeps)
    picture = draw_speeds(swept.model.name, swept.curves, swept.optima)
    save_picture(picture, options.output / "swim.png")
    for name, sweeps in varied.items():
        _draw_varied(name, sweeps, options.output / f"{_file_name(name)}.png")
    if options.json:
        options.json.write_text(json.dumps(_values(swept, varied), indent=1))
    console.print(f"Wrote {options.output / 'swim.csv'} and {options.output / 'swim.png'}.", soft_wrap=True)
    return 0


def _model(model: Model, values: dict[str, float]) -> Model:
    return model.with_freed(*values).with_values(values)


def _label(pair: tuple[float, float]) -> str:
    first, second = pair
    return f"{first:g} V" if first == second else f"{first:g}/{second:g} V"


def _sweep(pool: Executor, model: Model, options: argparse.Namespace, name: str) -> Swept:
    ledger = SweepLedger(options.output / f"{name}.csv", model, options.duration)
    drives = [Boxes(pair[0], pair[1], f) for pair in options.voltage for f in options.frequency]
    check_drives(model, drives, options.duration)
    with counted(name, "swims", len(set(drives))) as done:
        swam = {one.drive: one for one in sweep(pool, model, drives, options.duration, ledger, done)}
    curves = {
        _label(pair): [swam[Boxes(pair[0], pair[1], f)] for f in options.frequency]
        for pair in options.voltage
    }
    optima = {}
    for pair, (label, curve) in zip(options.voltage, curves.items(), strict=True):
        top = optimum([one.frequency_hz for one in curve], [one.speed_m_per_s for one in curve])
        optima[label] = top and _with_error(pool, model, top, pair, options)
    return Swept(model, curves, optima)


def _with_error(
    pool: Executor, model: Model, top: Optimum, pair: tuple[float, float], options: argparse.Namespace
) -> Optimum:
    """The optimum with what the parameters' standard errors mean for its frequency."""
    spacing = sorted(options.frequency)
    step = min((b - a for a, b in zip(spacing, spacing[1:], strict=False)), default=0.5)

    def speeds(cases: list[tuple[Model, float]]) -> list[float]:
        parts = [
            pool.submit(swim_together, case, [Boxes(pair[0], pair[1], f)], options.duration)
            for case, f in cases
        ]
        return [part.result()[0].speed_m_per_s for part in parts]

    error = standard_error_of(model, top, step, speeds)
    return Optimum(top.frequency, top.speed, top.at_edge, error)


def _vary(
    pool: Executor, model: Model, name: str, values: tuple[float, ...], options: argparse.Namespace
) -> dict[float, Swept]:
    out = {}
    for value in values:
        varied = _model(model, {name: value})
        out[value] = _sweep(pool, varied, options, f"{_file_name(name)}_{value:g}")
    return out


def _file_name(name: str) -> str:
    return name.replace(".", "_")


def _print(console: Console, swept: Swept) -> None:
    console.print(f"{swept.model.name}: swimming speed in mm/s (work in J/(kg m))", soft_wrap=True)
    table = _right("Hz", *swept.curves)
    for row in zip(*swept.curves.values(), strict=True):
        cells = [f"{1e3 * s.speed_m_per_s:.2f}  ({s.cost_of_transport_j_per_kg_m:.3g})" for s in row]
        table.add_row(f"{row[0].frequency_hz:g}", *cells)
    console.print(table)
    for label, top in swept.optima.items():
        console.print(f"{label}: {top or 'no swim could be followed'}.", soft_wrap=True)
    unsettled = [s for curve in swept.curves.values() for s in curve if not s.has_settled]
    if unsettled:
        console.print(
            f"{len(unsettled)} swims still change their speed by more than 5 % between the last two windows; a longer "
            "--duration settles them.",
            soft_wrap=True,
        )


def _print_varied(console: Console, name: str, sweeps: dict[float, Swept]) -> None:
    unit = next(iter(sweeps.values())).model.parameters[name].unit
    console.print(f"What {name} does to the optimum", soft_wrap=True)
    table = _right(f"{name}, {unit}", *next(iter(sweeps.values())).optima)
    for value, swept in sweeps.items():
        table.add_row(f"{value:g}", *map(_short, swept.optima.values()))
    console.print(table)


def _short(top: Optimum | None) -> str:
    if top is None:
        return "none"
    return f"{'at the edge, ' if top.at_edge else ''}{top.frequency:.2f} Hz, {1e3 * top.speed:.3g} mm/s"


def _right(*headings: str) -> Table:
    return Table(*[Column(heading, justify="right") for heading in headings])


def _draw_varied(name: str, sweeps: dict[float, Swept], path: Path) -> None:
    label = next(iter(next(iter(sweeps.values())).curves))
    curves = {f"{name} = {value:g}": swept.curves[label] for value, swept in sweeps.items()}
    tops = {f"{name} = {value:g}": swept.optima[label] for value, swept in sweeps.items()}
    save_picture(draw_speeds(f"{label}, by {name}", curves, tops), path)


def _values(swept: Swept, varied: dict[str, dict[float, Swept]]) -> dict[str, Any]:
    def of(one: Swept) -> dict[str, Any]:
        return {
            "model": one.model.name,
            "fingerprint": fingerprint(one.model),
            "swims": {label: [asdict(s) for s in curve] for label, curve in one.curves.items()},
            "optima": {
                label: top and {**asdict(top), "interval_hz": top.interval}
                for label, top in one.optima.items()
            },
        }

    by_name = {name: {f"{value:g}": of(s) for value, s in sweeps.items()} for name, sweeps in varied.items()}
    return {**of(swept), "free": by_name}


if __name__ == "__main__":
    from hasel_sim.commands import entry

    sys.exit(entry.swim())
