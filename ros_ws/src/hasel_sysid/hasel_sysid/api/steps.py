# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The steps as functions: load, model, simulate, fit, diagnose, improve, save."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeAlias

from hasel_recording import Recording, RecordingError
from hasel_sim.model import Model, load_model, save_model
from hasel_sim.parallel import executor

from hasel_sysid.api.drawing import path_of, written
from hasel_sysid.api.results import Diagnosed, Fitted, Improved, Recordings, Simulated
from hasel_sysid.candidates import named_effects
from hasel_sysid.comparison import compare
from hasel_sysid.dataset import for_model, load_experiments, prepared, simulable, usable
from hasel_sysid.errors import SysidError
from hasel_sysid.estimation import fit_baseline, identify
from hasel_sysid.experiment import GENTLEST, Experiment, check_unseen, counted_once
from hasel_sysid.improvement import diagnose as diagnosis_of
from hasel_sysid.improvement import improve as improvement_of
from hasel_sysid.problem import Problem

AnyModel: TypeAlias = Model | str | Path | Simulated | Improved
"""A model, a result that has one, or a model's name or file."""
AnyRecordings: TypeAlias = Sequence[Experiment | Recording | str | Path] | Experiment | Recording | str | Path
"""Recordings as `load` gives them, one of them, or paths."""


def load(
    *paths: str | Path | Iterable[str | Path],
    columns: Mapping[str, str] | str | None = None,
    drives: Sequence[str | Path] | str | Path | None = None,
) -> Recordings:
    """Read recordings (.csv, .mcap); a path may hold * and ?.

    columns: names and units of your own CSV columns, such as {"time": "t [ms]", "sin_theta": "angle_deg"}, or
    "time=t [ms],sin_theta=angle_deg"; drives: files that hold the drive, one for each recording or one for all. Raises
    RecordingError.
    """
    named = _flat(paths, (str, Path), "the path of a recording is expected: give one such as 'runs/*.csv'")
    found = [name for path in named for name in _matching(Path(path))]
    drives = [drives] if isinstance(drives, (str, Path)) else drives
    if not found:
        raise RecordingError("no recording was named; expected at least one path such as 'runs/*.csv'")
    return Recordings(load_experiments(found, columns, drives))


def model(name: str | Path = "swimmer", *effects: str) -> Model:
    """A model by name or file, with further effects (ids, or path/to/file.py:ClassName). Raises ModelError."""
    return load_model(name).with_effects(*_names(effects))


def save(model: AnyModel, path: str | Path) -> Path:
    """Write a model file, ready for `model`, the commands and the nodes. Raises SysidError."""
    chosen = _model(model)
    return written(path_of(path), lambda path: save_model(chosen, path))


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
    model = _model(model)
    seen, others = _apart(recordings, unseen)
    every = for_model(model, [*seen, *others])
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
    seen, others = _apart(recordings, unseen)
    start, fitted = _prepared(model, seen)
    with executor(jobs) as pool:
        fitted = simulable(start, fitted, pool, GENTLEST)
        result = identify(Problem(fitted, pool), start, method)
        others = simulable(result.model, for_model(start, others), pool) if others else []
        found = compare(result.model, fitted, pool, others, f"{_named(start)}, fitted")
    return Fitted(found, result)


def diagnose(
    model: AnyModel, recordings: AnyRecordings, effects: Sequence[str] | str | None = None, jobs: int = 1
) -> Diagnosed:
    """Fit, and rank the effects that the model may lack.

    effects: only this one or these; one written with a + before it is considered beside the whole catalogue.
    Raises SysidError, SimulationError, ModelError.
    """
    only = _candidates(effects)
    start, fitted = _prepared(model, _experiments(recordings))
    with executor(jobs) as pool:
        problem = Problem(simulable(start, fitted, pool, GENTLEST), pool)
        result = fit_baseline(problem, start)
        return Diagnosed(diagnosis_of(problem, result, only), result)


def improve(
    model: AnyModel,
    recordings: AnyRecordings,
    unseen: AnyRecordings = (),
    effects: Sequence[str] | str | None = None,
    jobs: int = 1,
) -> Improved:
    """Fit, diagnose, add, refit, until what is left is noise or nothing known explains it.

    unseen: recordings that are never fitted or chosen by; effects: as of `diagnose`.
    Raises SysidError, SimulationError, ModelError.
    """
    only = _candidates(effects)
    seen, others = _apart(recordings, unseen)
    start, fitted = _prepared(model, seen)
    with executor(jobs) as pool:
        others = for_model(start, others) if others else []
        fitted, others = (simulable(start, part, pool, GENTLEST) for part in (fitted, others))
        validation = Problem(others, pool) if others else None
        return Improved(improvement_of(Problem(fitted, pool), start, validation, only))


def _prepared(model: AnyModel, experiments: Sequence[Experiment]) -> tuple[Model, list[Experiment]]:
    """The model with an amplitude for every level of the recordings, and these with the model's channels."""
    model = _model(model)
    fitted = for_model(model.with_levels([]), experiments)
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
    found: list[Experiment] = []
    kinds = (Experiment, Recording, str, Path)
    for each in _flat(
        given, kinds, "recordings are expected: give h.load(...), or paths such as 'runs/*.csv'"
    ):
        if isinstance(each, Experiment):
            found.append(each)
        else:
            found += usable([each]) if isinstance(each, Recording) else load(each)
    return counted_once(found)


def _apart(
    recordings: AnyRecordings, unseen: AnyRecordings | None
) -> tuple[list[Experiment], list[Experiment]]:
    """The recordings to fit and the unseen ones. Raises SysidError where one is both."""
    seen, others = _experiments(recordings), _experiments(() if unseen is None else unseen)
    check_unseen(others, seen)
    return seen, others


def _candidates(effects: Sequence[str] | str | None) -> tuple[str, ...] | None:
    """Names of the effects to consider; None: all. Raises ModelError for one that is not known."""
    only = None if effects is None else _names(effects)
    named_effects(only)
    return only


def _names(effects: Iterable[str] | str) -> tuple[str, ...]:
    return tuple(
        _flat(effects, (str,), "the name of an effect is expected: give one such as 'quadratic_drag'")
    )


def _flat(given: Any, kinds: tuple[type, ...], expected: str) -> list[Any]:
    """One of these kinds, or several however nested, as a list. Raises SysidError for anything else."""
    if isinstance(given, kinds):
        return [given]
    if not isinstance(given, Iterable):
        raise SysidError(f"found a {type(given).__name__} where {expected}")
    return [each for part in given for each in _flat(part, kinds, expected)]


def _named(model: Model) -> str:
    """Name and effects, so that a picture tells two fits apart."""
    return " + ".join([model.name, *(effect.id for effect in model.effects)])


def _matching(path: Path) -> list[Path]:
    """The files that a path with * and ? means; any other path as it is."""
    wild = next((n for n, part in enumerate(path.parts) if "*" in part or "?" in part), None)
    if wild is None:
        return [path]
    return sorted(Path(*path.parts[:wild]).glob(str(Path(*path.parts[wild:])))) or [path]
