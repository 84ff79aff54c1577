"""Simulate every run and collect what is different."""

from collections.abc import Sequence
from concurrent.futures import Executor, as_completed

from hasel_common.progress import Workload
from hasel_sim.model import Model
from hasel_sim.parallel import submit_all
from hasel_sim.run import Simulation

from hasel_sysid.compare.comparison import Comparison
from hasel_sysid.compare.run_comparison import RunComparison
from hasel_sysid.compare.swimming_speed import swimming_speed
from hasel_sysid.data_gate import check_against_model, check_recording
from hasel_sysid.dataset import prepared
from hasel_sysid.errors import SysidError
from hasel_sysid.expected_work import work_of
from hasel_sysid.experiment import Experiment
from hasel_sysid.where_it_fails.analyse import where_it_fails
from hasel_sysid.where_it_fails.run_series import RunSeries, run_series


def compare(
    model: Model,
    experiments: Sequence[Experiment],
    pool: Executor,
    unseen: Sequence[Experiment] = (),
    label: str | None = None,
    workload: Workload | None = None,
) -> Comparison:
    """Simulate all experiments and the unseen ones with one model.

    A model without amplitudes gets its start values; one that has some keeps them, so that unseen levels are
    interpolated. label: what to call the model (default: its name); workload: counts the simulations.
    Raises SysidError for runs the body cannot have, SimulationError when the motion cannot be followed.
    """
    every = [*experiments, *unseen]
    if not every:
        raise SysidError("no recording was given; expected at least one: name .csv or .mcap files")
    model = with_amplitudes(model, every)
    simulations = _simulate(model, every, pool, workload)
    return comparison_of(model, experiments, simulations, unseen, label)


def with_amplitudes(model: Model, experiments: Sequence[Experiment]) -> Model:
    """The model itself when it has amplitudes, else with one for every voltage of the experiments."""
    started = prepared(model, experiments)
    return model if len(model.levels) else started


def comparison_of(
    model: Model,
    experiments: Sequence[Experiment],
    simulations: Sequence[Simulation],
    unseen: Sequence[Experiment] = (),
    label: str | None = None,
) -> Comparison:
    """Compare what has been simulated already; the simulations of the unseen experiments come last."""
    every = [*experiments, *unseen]
    series = [series_of(e, s) for e, s in zip(every, simulations, strict=True)]
    where = where_it_fails(series)
    seen = len(experiments)
    free = swims_freely(model)
    speeds = [
        swimming_speed(e.recording, simulation, s.cycle.period if s.cycle else None, free)
        for e, simulation, s in zip(every, simulations, series, strict=True)
    ]
    runs = tuple(
        RunComparison(s, n >= seen, a, speed)
        for n, (s, a, speed) in enumerate(zip(series, where.runs, speeds, strict=True))
    )
    set_up = []
    for experiment, simulation in zip(every, simulations, strict=True):
        recording = experiment.recording
        set_up += check_recording(recording)
        set_up += check_against_model(recording, simulation.sin_theta, simulation.markers)
    return Comparison(label or model.name, model, runs, where, tuple(set_up))


def swims_freely(model: Model) -> bool:
    """Whether the body is in a fluid and nothing holds it or its head marker, so that its way can be compared too."""
    described = model.description
    held = described.body.clamped or described.markers["head"].fixed
    return described.medium is not None and not held


def series_of(experiment: Experiment, simulation: Simulation) -> RunSeries:
    """Measured and simulated angle of one run. Raises SysidError when they have no frame in common."""
    schedule = experiment.run.schedule
    drive = None if schedule is None else (schedule.time, schedule.signal)
    series = run_series(
        experiment.name,
        experiment.run.time,
        experiment.sin_theta,
        simulation.sin_theta,
        drive,
        experiment.recording.channels,
    )
    if len(series.time) == 0:
        raise SysidError(
            f"{experiment.name} has no frame with both a measured and a simulated angle; "
            "check its time column and initial_time_s"
        )
    return series


def _simulate(
    model: Model, experiments: Sequence[Experiment], pool: Executor, workload: Workload | None
) -> list[Simulation]:
    futures = submit_all(pool, model, [experiment.run for experiment in experiments])
    if workload:
        for future in as_completed(futures):
            workload.did(work_of(model, [experiments[futures.index(future)].run]))
            workload.check()
    return [future.result() for future in futures]
