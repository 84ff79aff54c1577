# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Residuals of the outputs of many runs and their derivatives, with the unknown offset of each series taken out.

A series is one output of one run. All outputs are in one unit and of one noise level.
"""

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from hasel_common.progress import Workload
from hasel_sim.errors import ModelError, SimulationError
from hasel_sim.model import Model
from hasel_sim.parallel import submit_each
from hasel_sim.run import Simulation

from hasel_sysid.errors import SysidError
from hasel_sysid.expected_work import TimeLimit, work_of
from hasel_sysid.experiment import Experiment
from hasel_sysid.noise import NoiseModel, measured_noise
from hasel_sysid.policy import POLICY


@dataclass(frozen=True)
class Evaluation:
    """One model against all runs.

    residual: measured minus simulated outputs, run by run and output by output, the mean of every series removed (its
    offset is a nuisance), [frames], each output of a frame being one of them; jacobian: derivative of the simulated
    series by `names`, treated alike, [frames, parameters]; runs: number of the run each belongs to, [frames]; offsets:
    what was removed, [series]; measured_at: which outputs of every run are both measured and simulated, [n, outputs]
    of each; free_offset: whether nothing tells the offset of a series; else no mean is removed.
    """

    model: Model
    names: tuple[str, ...]
    simulations: tuple[Simulation, ...]
    residual: np.ndarray
    jacobian: np.ndarray
    runs: np.ndarray
    offsets: np.ndarray
    measured_at: tuple[np.ndarray, ...]
    free_offset: bool = True

    @cached_property
    def series(self) -> np.ndarray:
        """Number of the series that each belongs to, [frames]."""
        counts = [used.sum(axis=0) for used in self.measured_at]
        return np.repeat(np.arange(sum(map(len, counts))), np.concatenate(counts))

    def each_series(self) -> Iterator[tuple[Simulation, int, np.ndarray, np.ndarray]]:
        """Of every series: the simulation, the number of the output, the frames of the run that it has [n], and where
        they are [frames].
        """
        number = 0
        for simulation, used in zip(self.simulations, self.measured_at, strict=True):
            for output, here in enumerate(used.T):
                yield simulation, output, here, self.series == number
                number += 1

    @property
    def mean_absolute_error(self) -> float:
        """Mean |Δ sin θ| over all frames of all runs."""
        return float(np.abs(self.residual).mean())

    @property
    def sum_of_squares(self) -> float:
        """The residual sum of squares (RSS)."""
        return float(self.residual @ self.residual)

    def by(self, names: Sequence[str]) -> "Evaluation":
        """The same with derivatives by these of its parameters only, in this order."""
        columns = [self.jacobian[:, self.names.index(name)] for name in names]
        return replace(self, names=tuple(names), jacobian=np.reshape(columns, (-1, len(self.residual))).T)

    def of_runs(self, numbers: Sequence[int]) -> "Evaluation":
        """The same of some of the runs only."""
        here = np.concatenate([np.flatnonzero(self.runs == number) for number in numbers])
        return replace(
            self,
            simulations=tuple(self.simulations[number] for number in numbers),
            residual=self.residual[here],
            jacobian=self.jacobian[here],
            runs=np.repeat(np.arange(len(numbers)), [int((self.runs == n).sum()) for n in numbers]),
            offsets=np.reshape(self.offsets, (len(self.simulations), -1))[list(numbers)].ravel(),
            measured_at=tuple(self.measured_at[number] for number in numbers),
        )

    def simulated(self) -> np.ndarray:
        """The simulated outputs at the frames of `residual`, the mean of every series removed, [frames]."""
        chosen = [s.outputs[used, output] for s, output, used, _ in self.each_series()]
        return np.concatenate([s - s.mean() if self.free_offset and len(s) else s for s in chosen])

    def measured(self) -> np.ndarray:
        """The measured outputs at the same frames, the mean of every series removed, [frames]."""
        return self.simulated() + self.residual


_CLOSE = 0.15
"""Share of the motion up to which an error changes the motion to first order only."""


class Problem:
    """Measured runs to be explained; `evaluate` is the only thing that simulates.

    free_offset: whether nothing tells the offset that the frames of a series share.
    """

    free_offset = True

    def __init__(
        self,
        experiments: Sequence[Experiment],
        pool: Executor,
        noise: NoiseModel | None = None,
        time_limit: TimeLimit | None = None,
        workload: Workload | None = None,
    ) -> None:
        """noise: of the measured outputs, where it is known; otherwise it is looked for in the recordings.
        time_limit: of the search for an explanation, whose parts look at it themselves; workload: counts simulations.
        """
        if not experiments:
            raise SysidError("no recording was given; expected at least one: name .csv or .mcap files")
        self.experiments, self.pool = tuple(experiments), pool
        self.evaluations = 0
        self._noise = noise
        self.time_limit = time_limit or TimeLimit()
        self.workload = workload or Workload()

    @cached_property
    def measured_noise(self) -> NoiseModel | None:
        """The noise as given, between repeated runs or at rest; None where nothing shows it alone."""
        return self._noise or measured_noise(self.experiments)

    @cached_property
    def largest_swing(self) -> float:
        """Largest |output| from the mean of its series."""
        series = [s[np.isfinite(s)] for e in self.experiments for s in e.outputs.T]
        return max((float(np.abs(s - s.mean()).max()) for s in series if len(s)), default=0.0)

    @property
    def discrepancy(self) -> float:
        """What no model of these runs is without, rms."""
        return POLICY.discrepancy * self.largest_swing

    def low_fidelity(self, model: Model) -> Model:
        """The model by which steps are tried before it is simulated itself."""
        return low_fidelity(model)

    @property
    def shared_errors(self) -> Sequence[np.ndarray]:
        """Changes [frames] of the measured series by what was set once for all runs, each by one standard deviation."""
        return ()

    def refinements(self, model: Model) -> dict[str, Model]:
        """The model by finer numerics, by what is finer: what they change is the error of the discretisation."""
        return refinements(model)

    def with_experiments(self, experiments: Sequence[Experiment]) -> "Problem":
        """The same with parts of its runs or some of them, in as much noise."""
        out = copy(self)
        out.experiments, out.evaluations, out._noise = tuple(experiments), 0, self.measured_noise
        for measured in ("measured_noise", "largest_swing"):
            out.__dict__.pop(measured, None)
        return out

    def work(self, model: Model, names: Sequence[str] = ()) -> float:
        """Of simulating every run with derivatives by so many parameters, in proportion to the time that it takes."""
        return work_of(model, [experiment.run for experiment in self.experiments], len(names))

    def evaluate(self, model: Model, names: Sequence[str] = ()) -> Evaluation:
        """Simulate every run with the model, with derivatives by the named parameters."""
        result = self.evaluate_each([model], [names])[0]
        if isinstance(result, SimulationError):
            raise result
        return result

    def evaluate_each(
        self, models: Sequence[Model], names: Sequence[Sequence[str]]
    ) -> list[Evaluation | SimulationError]:
        """Several models at once, so that all workers stay busy; the error of one that cannot be simulated."""
        self.workload.check()
        runs = [experiment.run for experiment in self.experiments]

        def count(model: int, run: int) -> None:
            self.workload.did(work_of(models[model], [runs[run]], len(names[model])))

        pending = submit_each(self.pool, models, runs, names, count)
        self.evaluations += len(models)
        results: list[Evaluation | SimulationError] = []
        for model, by, futures in zip(models, names, pending, strict=True):
            try:
                results.append(self._collect(model, tuple(by), [future.result() for future in futures]))
            except SimulationError as error:
                results.append(error)
            except ModelError as error:  # values with which this body cannot be built
                results.append(SimulationError(str(error)))
        return results

    def _collect(self, model: Model, names: tuple[str, ...], simulations: list[Simulation]) -> Evaluation:
        residuals, jacobians, runs, offsets, measured_at = [], [], [], [], []
        for number, (experiment, simulation) in enumerate(zip(self.experiments, simulations, strict=True)):
            measured, simulated = experiment.outputs, simulation.outputs
            used = np.isfinite(measured) & np.isfinite(simulated)
            if not used.any():
                raise SysidError(
                    f"{experiment.name} has no frame with both a measured and a simulated angle; "
                    "check its time column and initial_time_s"
                )
            measured_at.append(used)
            for output, here in enumerate(used.T):
                difference = measured[here, output] - simulated[here, output]
                slopes = simulation.output_slopes[here, output]
                if not np.isfinite(slopes).all():
                    finite = np.isfinite(slopes).all(axis=0)
                    lost = [name for name, known in zip(names, finite, strict=True) if not known]
                    raise SimulationError(
                        f"{experiment.name}: the derivatives by {', '.join(lost)} are not finite there; "
                        "choose another start, or leave these parameters as they are"
                    )
                centred = self.free_offset and len(difference) > 0
                offsets.append(difference.mean() if centred else 0.0)
                residuals.append(difference - offsets[-1])
                jacobians.append(slopes - slopes.mean(axis=0) if centred else slopes)
                runs.append(np.full(len(difference), number))
        return Evaluation(
            model,
            names,
            tuple(simulations),
            np.concatenate(residuals),
            np.concatenate(jacobians),
            np.concatenate(runs),
            np.array(offsets),
            tuple(measured_at),
            self.free_offset,
        )


def low_fidelity(model: Model) -> Model:
    """The model at half the cost: seven tenths of the mesh density, reduced quadrature and half the steps."""
    numerics = model.description.numerics
    return model.with_numerics(
        mesh_density=0.7 * numerics.mesh_density,
        quadrature_order=2,
        steps_per_second=0.5 * numerics.steps_per_second,
    )


def refinements(model: Model) -> dict[str, Model]:
    """The model on a mesh finer along and across it, and with shorter time steps.

    Where the drive passes levels at which no amplitude is known, also with another curve between those that are: no
    finer one is to be had, and either is as likely.
    """
    numerics = model.description.numerics
    found = {
        "mesh": model.with_numerics(mesh_density=1.5 * numerics.mesh_density, layers=numerics.layers + 1),
        "time_step": model.with_numerics(steps_per_second=2 * numerics.steps_per_second),
    }
    if any(map(model.is_onset, model.parameters)):
        other = "power" if numerics.amplitude_curve == "cubic" else "cubic"
        found["amplitude_curve"] = model.with_numerics(amplitude_curve=other)
    return found


class LowFidelityProblem(Problem):
    """The same runs by the low-fidelity model, its error at one evaluated model added back.

    The additive correction of multi-fidelity optimisation (Alexandrov et al. 2001): at that model the residuals are the
    same to the last digit. A low-fidelity model that cannot follow the motion is not used at all.
    """

    def __init__(self, of: Problem, known: Evaluation | None = None) -> None:
        """known: a model, evaluated by `of`; without one nothing is known of the error, and none is added."""
        super().__init__(of.experiments, of.pool, of.measured_noise, of.time_limit, of.workload)
        self._known, self._of, self._lower = known, of, of.low_fidelity
        self._error: np.ndarray | float = 0.0
        if known is None:
            return
        try:
            error = known.residual - of.evaluate(of.low_fidelity(known.model)).residual
        except SimulationError:
            self._lower = _as_it_is
            return
        if np.linalg.norm(error) <= _CLOSE * np.linalg.norm(known.simulated()):
            self._error = error
        else:
            self._lower = _as_it_is

    @property
    def known(self) -> Evaluation:
        """The evaluated model whose error is added back. Raises SysidError where none was given."""
        if self._known is None:
            raise SysidError("of no model is the low-fidelity error known; give one that was evaluated")
        return self._known

    def of_runs(self, numbers: Sequence[int]) -> "LowFidelityProblem":
        """The same with some of its runs only."""
        out = copy(self)
        out._of = self._of.with_experiments([self.experiments[number] for number in numbers])
        out.experiments, out._known = out._of.experiments, self.known.of_runs(numbers)
        if isinstance(self._error, np.ndarray):
            out._error = np.concatenate([self._error[self.known.runs == number] for number in numbers])
        return out

    def evaluate_each(
        self, models: Sequence[Model], names: Sequence[Sequence[str]]
    ) -> list[Evaluation | SimulationError]:
        """As of a problem; the models of the results are those that were asked for."""
        self.evaluations += len(models)
        found = self._of.evaluate_each([self._lower(model) for model in models], names)
        return [
            one
            if isinstance(one, SimulationError)
            else replace(one, model=model, residual=one.residual + self._error)
            for model, one in zip(models, found, strict=True)
        ]


def _as_it_is(model: Model) -> Model:
    return model
