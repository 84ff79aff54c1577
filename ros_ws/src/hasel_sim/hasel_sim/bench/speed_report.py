"""The benchmark's results as tables, beside the bars."""

from dataclasses import asdict, dataclass

from hasel_common.measured_bar import MeasuredBar
from rich.console import Console
from rich.table import Table

from hasel_sim.bench.convergence import MeshError, StepError
from hasel_sim.bench.speed import SideBySide, Speed


@dataclass(frozen=True)
class SpeedReport:
    """All speeds; slope: of log cost against log nodes; parameters: (number, cost over forward).

    free_swim: real-time factor of a free swim of 10 s with every force of the fluid.
    """

    first_run: float
    sizes: list[Speed]
    default: Speed
    large: Speed
    slope: float
    parameters: list[tuple[int, float]]
    lanes: SideBySide
    profile: list[tuple[str, float]]
    free_swim: float

    def bars(self) -> list[MeasuredBar]:
        """The figures that have a bar."""
        named = (("default mesh", self.default), (f"{self.large.nodes} nodes", self.large))
        return [
            MeasuredBar(f"real-time factor, {named[0][0]}", self.default.real_time_factor, 5, at_least=True),
            MeasuredBar(f"real-time factor, {named[1][0]}", self.large.real_time_factor, 2, at_least=True),
            MeasuredBar(
                "real-time factor, free swim of 10 s with every force of the fluid",
                self.free_swim,
                5,
                at_least=True,
            ),
            *(
                MeasuredBar(f"all sensitivities / forward, {name}", s.sensitivities / s.forward, 2)
                for name, s in named
            ),
            *(MeasuredBar(f"adjoint sweep / forward, {name}", s.adjoint / s.forward, 2) for name, s in named),
            MeasuredBar(
                f"{self.lanes.runs} runs side by side / one after the other",
                self.lanes.forward_ratio,
                4,
                at_least=True,
            ),
            MeasuredBar("first run, compiling (s)", self.first_run, 30),
        ]

    def values(self) -> dict:
        """Everything as plain values, for JSON."""
        return asdict(self) | {"bars": [asdict(bar) | {"met": bar.met} for bar in self.bars()]}

    def print(self, console: Console) -> None:
        """Print the tables."""
        console.print(
            self._speed_table(),
            self._parameter_table(),
            self._lanes_table(),
            self._profile_table(),
            bars_table(self.bars()),
        )

    def _speed_table(self) -> Table:
        table = Table(title=f"Processor time on one core, 240 steps/s; cost grows as nodes^{self.slope:.2f}")
        for heading in (
            "nodes",
            "ms/frame",
            "x real time",
            "all sensitivities",
            "adjoint sweep",
            "LAPACK/step",
        ):
            table.add_column(heading, justify="right")
        for speed in self.sizes:
            ratios = [f"{part / speed.forward:.2f} x" for part in (speed.sensitivities, speed.adjoint)]
            frame = f"{speed.milliseconds(speed.forward):.2f}"
            solutions = f"{speed.solutions_per_step:.1f}"
            table.add_row(str(speed.nodes), frame, f"{speed.real_time_factor:.1f}", *ratios, solutions)
        return table

    def _parameter_table(self) -> Table:
        table = Table(title="Forward cost with sensitivities, by number of parameters (six effects)")
        for count, _ in self.parameters:
            table.add_column(str(count), justify="right")
        table.add_row(*(f"{ratio:.2f} x" for _, ratio in self.parameters))
        return table

    def _lanes_table(self) -> Table:
        lanes = self.lanes
        table = Table(title=f"{lanes.runs} runs of 0.5 s, default mesh, processor time")
        for heading in ("", "one after the other", "side by side", "ratio"):
            table.add_column(heading, justify="right" if heading else "left")
        for name, alone, beside, ratio in (
            ("forward", lanes.after_the_other, lanes.side_by_side, lanes.forward_ratio),
            (
                "with all sensitivities",
                lanes.sensitivities_after_the_other,
                lanes.sensitivities_side_by_side,
                lanes.sensitivities_ratio,
            ),
        ):
            table.add_row(name, f"{1e3 * alone:.0f} ms", f"{1e3 * beside:.0f} ms", f"{ratio:.2f} x")
        return table

    def _profile_table(self) -> Table:
        table = Table("where the time goes", "share", title="Default mesh, forward")
        for label, share in self.profile:
            table.add_row(label, f"{100 * share:.0f} %")
        return table


@dataclass(frozen=True)
class ConvergenceReport:
    """Errors of mesh and time step."""

    meshes: list[MeshError]
    steps: list[StepError]

    def values(self) -> dict:
        """Everything as plain values, for JSON."""
        return asdict(self)

    def print(self, console: Console) -> None:
        """Print the tables."""
        table = Table(title="Mean |difference of sin theta| from the finest mesh, 5.5 kV, 2 Hz")
        for heading in ("quadrature", "mesh density", "nodes", "error"):
            table.add_column(heading, justify="right")
        for each in self.meshes:
            order = each.quadrature_order
            table.add_row(
                f"{order} x {order}", f"{each.mesh_density:g}", str(each.nodes), f"{each.error:.4f}"
            )
        steps = Table("steps/s", "error", title="The same, from 1920 steps a second on the default mesh")
        for step in self.steps:
            steps.add_row(f"{step.steps_per_second:g}", f"{step.error:.5f}")
        console.print(table, steps)


def bars_table(bars: list[MeasuredBar]) -> Table:
    """Measured values beside their bars."""
    table = Table("what", "measured", "bar", "met", title="Bars")
    for bar in bars:
        sign = "≥" if bar.at_least else "≤"
        table.add_row(bar.what, f"{bar.measured:.2f}", f"{sign} {bar.limit:g}", "yes" if bar.met else "NO")
    return table
