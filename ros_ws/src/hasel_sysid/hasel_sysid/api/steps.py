"""The steps as functions: load, model, simulate, fit, diagnose, improve, save."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TypeAlias

from hasel_recording import Recording, RecordingError
from hasel_sim.model import Model, load_model, save_model
from hasel_sim.parallel import executor

from hasel_sysid.api.results import Diagnosed, Fitted, Improved, Recordings, Simulated
from hasel_sysid.compare import compare
from hasel_sysid.dataset import for_model, load_experiments, prepared, simulable, usable
from hasel_sysid.errors import SysidError
from hasel_sysid.estimation import fit_baseline, identify
from hasel_sysid.experiment import GENTLEST, Experiment
from hasel_sysid.improvement import diagnose as diagnosis_of
from hasel_sysid.improvement import improve as improvement_of
from hasel_sysid.problem import Problem

AnyModel: TypeAlias = Model | str | Path | Simulated | Improved
"""A model, a result that has one, or a model's name or file."""
AnyRecordings: TypeAlias = Sequence[Experiment | Recording | str | Path] | Experiment | Recording | str | Path
"""Recordings as `load` gives them, one of them, or paths."""


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


def save(model: AnyModel, path: str | Path) -> Path:
    """Write a model file, ready for `model`, the commands and the nodes."""
    save_model(_model(model), path)
    return Path(path)


def simulate(
    model: AnyModel,
    recordings: AnyRecordings,
    unseen: AnyRecordings = (),
    jobs: int = 1,
    label: str | None = None,
) -> Simulated:
    """Simulate recordings under their own drive and compare.

    label: what to call the model (default: its name and effects).
    Raises SysidError where model and recordings do not fit, SimulationError.
    """
    model, seen = _model(model), _experiments(recordings)
    every = for_model(model, [*seen, *_experiments(unseen)])
    count = len(seen)
    with executor(jobs) as pool:
        return Simulated(compare(model, every[:count], pool, every[count:], label or _named(model)))


def fit(
    model: AnyModel,
    recordings: AnyRecordings,
    unseen: AnyRecordings = (),
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
        others = simulable(result.model, for_model(start, _experiments(unseen)), pool) if unseen else []
        found = compare(result.model, fitted, pool, others, f"{_named(start)}, fitted")
    return Fitted(found, result)


def diagnose(
    model: AnyModel, recordings: AnyRecordings, effects: Sequence[str] | None = None, jobs: int = 1
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
    model: AnyModel,
    recordings: AnyRecordings,
    unseen: AnyRecordings = (),
    effects: Sequence[str] | None = None,
    jobs: int = 1,
) -> Improved:
    """Fit, diagnose, add, refit, until what is left is noise or nothing known explains it.

    unseen: recordings that are never fitted or chosen by; effects: as of `diagnose`.
    Raises SysidError, SimulationError, ModelError.
    """
    start, fitted = _prepared(model, recordings)
    with executor(jobs) as pool:
        others = for_model(start, _experiments(unseen)) if unseen else []
        fitted, others = (simulable(start, part, pool, GENTLEST) for part in (fitted, others))
        validation = Problem(others, pool) if others else None
        return Improved(improvement_of(Problem(fitted, pool), start, validation, effects))


def _prepared(model: AnyModel, recordings: AnyRecordings) -> tuple[Model, list[Experiment]]:
    """The model with an amplitude for every level of the recordings, and these with the model's channels."""
    model = _model(model)
    fitted = for_model(model.with_levels([]), _experiments(recordings))
    return prepared(model, fitted), fitted


def _model(given: AnyModel) -> Model:
    """The model itself, or the one of this name or file."""
    if isinstance(given, (str, Path)):
        return load_model(given)
    if isinstance(given, (Simulated, Improved)):
        return given.model
    if isinstance(given, Model):
        return given
    raise SysidError(
        f"found a {type(given).__name__} where a model is expected: give h.model(...), the name of one such as "
        "'swimmer', or its file"
    )


def _experiments(given: AnyRecordings) -> list[Experiment]:
    """The recordings themselves, or those at a path or several."""
    if isinstance(given, (str, Path)):
        return list(load(given))
    found: list[Experiment] = []
    for each in given if isinstance(given, Iterable) else [given]:
        if isinstance(each, (str, Path)):
            found += load(each)
        elif isinstance(each, Recording):
            found += usable([each])
        elif isinstance(each, Experiment):
            found.append(each)
        else:
            raise SysidError(
                f"found a {type(each).__name__} where recordings are expected: give h.load(...), or paths such as "
                "'runs/*.csv'"
            )
    return found


def _named(model: Model) -> str:
    """Name and effects, so that a picture tells two fits apart."""
    return " + ".join([model.name, *(effect.id for effect in model.effects)])


def _matching(path: Path) -> list[Path]:
    """The files that a path with * and ? means; any other path as it is."""
    wild = next((n for n, part in enumerate(path.parts) if "*" in part or "?" in part), None)
    if wild is None:
        return [path]
    return sorted(Path(*path.parts[:wild]).glob(str(Path(*path.parts[wild:])))) or [path]
