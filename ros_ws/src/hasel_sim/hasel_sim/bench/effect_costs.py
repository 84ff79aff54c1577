# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What every effect of the catalogue costs: a run with it, and with all sensitivities, over the run without it."""

import itertools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from hasel_common.measured_bar import MeasuredBar
from rich.console import Console

from hasel_sim.bench.cases import BarsReport, bars_table, box_run, fitted_swimmer, processor_seconds, table_of
from hasel_sim.effects.registry import catalogue
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model
from hasel_sim.simulate import simulate_many

REPEATS, DURATION_S = 3, 1.0
FLUID, DEPTH_M = "canola_oil", 0.05
FORWARD_BAR, MEDIAN_BAR, SENSITIVITIES_BAR = 1.3, 1.1, 2.0


@dataclass(frozen=True)
class EffectCost:
    """Processor time of four runs side by side.

    forward: with the effect at its typical values, over the runs without any; sensitivities: with the derivatives by
    all parameters, the baseline's and its own, over the same runs forward.
    """

    id: str
    place: str
    forward: float
    sensitivities: float


@dataclass(frozen=True)
class EffectsReport(BarsReport):
    """All effects, and the baseline: seconds of its four runs, and its sensitivities over them."""

    baseline_s: float
    baseline_sensitivities: float
    effects: list[EffectCost]

    def bars(self) -> list[MeasuredBar]:
        """The figures that have a bar."""
        forward = [effect.forward for effect in self.effects]
        sensitivities = [self.baseline_sensitivities, *(effect.sensitivities for effect in self.effects)]
        return [
            MeasuredBar("dearest effect / without", max(forward), FORWARD_BAR),
            MeasuredBar("effect in the middle / without", float(np.median(forward)), MEDIAN_BAR),
            MeasuredBar("all sensitivities / forward, dearest", max(sensitivities), SENSITIVITIES_BAR),
        ]

    def print(self, console: Console) -> None:
        """Print the table and the bars."""
        baseline = "none", "", f"{1e3 * self.baseline_s:.0f} ms", f"{self.baseline_sensitivities:.2f} x"
        rows = [
            (effect.id, effect.place, f"{effect.forward:.2f} x", f"{effect.sensitivities:.2f} x")
            for effect in self.effects
        ]
        title = f"Four runs of {DURATION_S:g} s side by side, default mesh, processor time"
        headings = ("effect", "place", "forward / without", "all sensitivities / forward")
        console.print(table_of(title, headings, [baseline, *rows], words=2), bars_table(self.bars()))


def measure_effects(repeats: int = REPEATS, duration: float = DURATION_S) -> EffectsReport:
    """Time every effect and the baseline in turns, on the swimmer in oil. Raises SimulationError where a run fails."""
    plain = fitted_swimmer().in_medium(FLUID, DEPTH_M)
    works: list[Callable[[], None]] = []
    for model in (plain, *(_with_typical(plain, name) for name in catalogue())):
        works += [_runs(model, duration, ()), _runs(model, duration, tuple(model.parameters))]
    seconds = processor_seconds(works, repeats)
    (bare, derived), *others = zip(seconds[::2], seconds[1::2], strict=True)
    effects = [
        EffectCost(effect.id, effect.place, forward / bare, sensitivities / forward)
        for effect, (forward, sensitivities) in zip(catalogue().values(), others, strict=True)
    ]
    return EffectsReport(bare, derived / bare, effects)


def _with_typical(model: Model, name: str) -> Model:
    values = {f"{name}.{key}": value for key, value in catalogue()[name].typical().items()}
    return model.with_effects(name).with_values(values)


def _runs(model: Model, duration: float, names: tuple[str, ...]) -> Callable[[], None]:
    drives = itertools.product((5500.0, 4500.0), (2.0, 3.5))
    cases = [(model, box_run(duration, *drive)) for drive in drives]

    def work() -> None:
        failed = [result for result in simulate_many(cases, names) if isinstance(result, SimulationError)]
        if failed:
            raise failed[0]

    return work
