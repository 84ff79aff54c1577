"""The steps as functions: load, model, simulate, fit, diagnose, improve, save."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from hasel_recording import RecordingError
from hasel_sim.model import Model, load_model, save_model
from hasel_sim.parallel import executor

from hasel_sysid.api.results import Diagnosed, Fitted, Improved, Recordings, Simulated
from hasel_sysid.compare import compare
from hasel_sysid.dataset import for_model, load_experiments, prepared, simulable
from hasel_sysid.estimation import fit_baseline, identify
from hasel_sysid.experiment import GENTLEST, Experiment
from hasel_sysid.improvement import diagnose as diagnosis_of
from hasel_sysid.improvement import improve as improvement_of
from hasel_sysid.problem import Problem


def load(
    *paths: str | Path,
    columns: Mapping[str, str] | None = None,
    drives: Sequence[str | Path] | None = None,
) -> Recordings:
    """Read recordings (.csv, .mcap); a path may hold * and ?.

    columns: names and units of your own CSV columns, such as {"time": "t [ms]", "sin_theta": "angle_deg"}; drives:
    files that hold the drive, one for each recording or one for all. Raises RecordingError.
    """
    found = [name for path in paths for name in _matching(Path(path))]
    if not found:
        raise RecordingError("no recording was named; expected at least one path such as 'runs/*.csv'")
    return Recordings(load_experiments(found, columns, drives))


def model(name: str | Path = "swimmer", *effects: str) -> Model:
    """A model by name or file, with further effects (ids, or path/to/file.py:ClassName). Raises ModelError."""
    return load_model(name).with_effects(*effects)


def save(model: Model, path: str | Path) -> Path:
    """Write a model file, ready for `model`, the commands and the nodes."""
    save_model(model, path)
    return Path(path)


def simulate(
    model: Model,
    recordings: Sequence[Experiment],
    unseen: Sequence[Experiment] = (),
    jobs: int = 1,
    label: str | None = None,
) -> Simulated:
    """Simulate recordings under their own drive and compare.

    label: what to call the model (default: its name and effects).
    Raises SysidError where model and recordings do not fit, SimulationError.
    """
    every = for_model(model, [*recordings, *unseen])
    count = len(recordings)
    with executor(jobs) as pool:
        return Simulated(compare(model, every[:count], pool, every[count:], label or _named(model)))


def fit(
    model: Model,
    recordings: Sequence[Experiment],
    unseen: Sequence[Experiment] = (),
    method: str = "least_squares",
    jobs: int = 1,
) -> Fitted:
    """Fit the model's free parameters to recordings; `unseen` ones are only compared with.

    jobs: processes; more than one only where the caller's main module can be imported (not in a bare script).
    Raises SysidError, SimulationError.
    """
    start, fitted = _prepared(model, recordings)
    with executor(jobs) as pool:
        fitted = simulable(start, fitted, pool, GENTLEST)
        result = identify(Problem(fitted, pool), start, method)
        others = simulable(result.model, for_model(model, unseen), pool) if unseen else []
        found = compare(result.model, fitted, pool, others, f"{_named(model)}, fitted")
    return Fitted(found, result)


def diagnose(
    model: Model, recordings: Sequence[Experiment], effects: Sequence[str] | None = None, jobs: int = 1
) -> Diagnosed:
    """Fit, and rank the effects that the model may lack.

    effects: only these; one written with a + before it is considered beside the whole catalogue.
    Raises SysidError, SimulationError, ModelError.
    """
    start, fitted = _prepared(model, recordings)
    with executor(jobs) as pool:
        problem = Problem(simulable(start, fitted, pool, GENTLEST), pool)
        result = fit_baseline(problem, start)
        return Diagnosed(diagnosis_of(problem, result, effects), result)


def improve(
    model: Model,
    recordings: Sequence[Experiment],
    unseen: Sequence[Experiment] = (),
    effects: Sequence[str] | None = None,
    jobs: int = 1,
) -> Improved:
    """Fit, diagnose, add, refit, until what is left is noise or nothing known explains it.

    unseen: recordings that are never fitted or chosen by; effects: as of `diagnose`.
    Raises SysidError, SimulationError, ModelError.
    """
    start, fitted = _prepared(model, recordings)
    with executor(jobs) as pool:
        fitted, others = (
            simulable(start, part, pool, GENTLEST) for part in (fitted, for_model(model, unseen))
        )
        validation = Problem(others, pool) if others else None
        return Improved(improvement_of(Problem(fitted, pool), start, validation, effects))


def _prepared(model: Model, recordings: Sequence[Experiment]) -> tuple[Model, list[Experiment]]:
    """The model with an amplitude for every level of the recordings, and these with the model's channels."""
    fitted = for_model(model.with_levels([]), recordings)
    return prepared(model, fitted), fitted


def _named(model: Model) -> str:
    """Name and effects, so that a picture tells two fits apart."""
    return " + ".join([model.name, *(effect.id for effect in model.effects)])


def _matching(path: Path) -> list[Path]:
    """The files that a path with * and ? means; any other path as it is."""
    wild = next((n for n, part in enumerate(path.parts) if "*" in part or "?" in part), None)
    if wild is None:
        return [path]
    return sorted(Path(*path.parts[:wild]).glob(str(Path(*path.parts[wild:])))) or [path]
