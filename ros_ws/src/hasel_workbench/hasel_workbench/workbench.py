# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""One session: runs, model, what was tried and kept; all that a page shows, without any page."""

import threading
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor, Future
from contextlib import contextmanager
from dataclasses import replace
from itertools import chain, count
from pathlib import Path

from hasel_common.progress import Workload
from hasel_recording import Recording
from hasel_sim.model import Model, save_model
from hasel_sim.run import Simulation
from hasel_sim.simulate import simulate
from hasel_sysid.candidates import effects_of
from hasel_sysid.command_line.inputs import chosen_model
from hasel_sysid.comparison import with_amplitudes
from hasel_sysid.errors import SysidError
from hasel_sysid.expected_work import USUAL_SPEED, plan_of_diagnosis, plan_of_fit
from hasel_sysid.experiment import Experiment
from hasel_sysid.improvement import diagnose
from hasel_sysid.problem import Problem

from hasel_workbench import acts
from hasel_workbench.cards import Card, cards
from hasel_workbench.jobs import Progress
from hasel_workbench.recordings import ReadingChoices, checked, file_place, place_of, read
from hasel_workbench.session_files import StepLedger, export
from hasel_workbench.state import SessionState
from hasel_workbench.step import Prediction, Step, predicted


def silent(_text: str, _share: float) -> None:
    """The progress of who does not wait."""


class Workbench:
    """Whatever changes the session takes a `progress`, which may raise to break it off: then nothing has changed.

    pool: simulates all runs; hand: one run at a time for who drags a value, never busy with anything long; folder: for
    model files, uploads and exports; model: name or file, None for what the recordings say; effects: the only ones that
    are considered, as of the commands' --effects; version: grows with every change.
    """

    def __init__(
        self,
        pool: Executor,
        hand: Executor,
        folder: Path,
        model: str | None = None,
        effects: tuple[str, ...] | None = None,
        reading: ReadingChoices = ReadingChoices(),  # noqa: B008  frozen
    ) -> None:
        self.pool, self.hand, self.folder, self.effects = pool, hand, folder, effects
        self.state, self.version = SessionState(), 0
        self.reading, self._asked = reading, model
        self._ledger = StepLedger(folder)
        self._changing = threading.Lock()

    def load(self, paths: Sequence[str | Path], unseen: bool = False, progress: Progress = silent) -> None:
        """Read recordings, check them and compare; what cannot be read becomes a banner. Every step is judged anew.

        unseen: never fitted. Raises SysidError where there is nothing to fit yet.
        """
        found, said, unread = read(paths, self.reading, unseen)
        with self._change() as state:
            others = tuple(each for each in state.unread if each.path not in map(Path, paths))
            again = {file_place(path) for path in paths} - {place_of(each.recording) for each in state.every}
            state = state.without_word_of(again).with_banners(said)
            self._commit(replace(state, unread=(*others, *unread)))
            if found:
                self._take(found, unseen, progress)

    def read_as(self, path: Path, columns: Mapping[str, str], progress: Progress = silent) -> None:
        """Read a file that could not be read, now that its columns are named, as of --map."""
        (unread,) = [each for each in self.state.unread if each.path == path]
        self.reading = replace(self.reading, own={**self.reading.own, str(path): dict(columns)})
        self.load([path], unread.unseen, progress)

    def pass_over(self, path: Path) -> None:
        """Do without a file that could not be read."""
        with self._change() as state:
            others = tuple(each for each in state.unread if each.path != path)
            self._commit(replace(state.without_word_of([file_place(path)]), unread=others))

    def remove(self, run: str, progress: Progress = silent) -> None:
        """Do without a run; every step is judged anew. Raises SysidError for the last one that is fitted."""
        with self._change() as state:
            number = state.number_of(run)
            state = state.without_word_of([place_of(state.every[number].recording)])
            others = [each for each in state.every if each.name != run]
            fitted = len(state.experiments) - (number < len(state.experiments))
            self._regroup(state, others[:fitted], others[fitted:], progress)

    def set_unseen(self, run: str, unseen: bool, progress: Progress = silent) -> None:
        """Never fit a run any more, or fit it from now on; every step is judged anew.

        Raises SysidError where no run to fit would be left.
        """
        with self._change() as state:
            chosen = state.every[state.number_of(run)]
            fitted = [each for each in state.experiments if each is not chosen]
            others = [each for each in state.unseen if each is not chosen]
            (others if unseen else fitted).append(chosen)
            self._regroup(state, fitted, others, progress)

    def take(
        self, recordings: Sequence[Recording], unseen: bool = False, progress: Progress = silent
    ) -> None:
        """The same with recordings that were read already; those that were taken before are left out.

        Raises SysidError where none is new.
        """
        with self._change() as state:
            known = [place_of(each.recording) for each in state.every]
            new = [each for each in recordings if place_of(each) not in known]
            if not new:
                raise SysidError(f"nothing new: all {len(recordings)} runs are loaded already")
            self._take(new, unseen, progress)

    def fit(self, progress: Progress = silent) -> None:
        """Fit what is being tried, which goes on being tried; else the current model, as a new step."""
        with self._change() as state:
            plan = plan_of_fit(acts.size_of(state))
            work = Workload(plan, usual_speed=USUAL_SPEED, tell=progress)
            step, _ = acts.fitted(state, self.pool, work)
            self._commit(replace(state, trial=step) if state.trial else self._kept(state, step))

    def diagnose(self, progress: Progress = silent) -> None:
        """Rank the effects that the current model may lack; fits it first where that was not done."""
        with self._change() as state:
            if state.trial is not None:
                raise SysidError(f"'{state.trial.label}' is being tried; keep it or take it back first")
            plan = plan_of_diagnosis(acts.size_of(state), len(effects_of(state.current.model, self.effects)))
            work = Workload(plan, usual_speed=USUAL_SPEED, tell=progress)
            fit = state.current.fit
            if fit is None:
                step, fit = acts.fitted(state, self.pool, work)
                state = self._kept(state, step)
                self._commit(state)
            problem = Problem(state.experiments, self.pool, workload=work)
            found = diagnose(problem, fit, self.effects)
            self._commit(replace(state, diagnosis=found, diagnosed=state.at, suggestions=()))

    def switch_on(self, effect: str, progress: Progress = silent) -> None:
        """Try the current model with an effect, at the values that the diagnosis found, else at typical ones."""
        with self._change() as state:
            trial = acts.with_effect(state, effect, self.effects, self.pool, progress)
            self._commit(replace(state, trial=trial))

    def switch_off(self, effect: str, progress: Progress = silent) -> None:
        """Try the current model without an effect that it has."""
        with self._change() as state:
            self._commit(replace(state, trial=acts.without_effect(state, effect, self.pool, progress)))

    def set_values(self, values: Mapping[str, float], progress: Progress = silent) -> None:
        """Try other values of some parameters."""
        with self._change() as state:
            self._commit(replace(state, trial=acts.with_values(state, values, self.pool, progress)))

    def keep(self) -> None:
        """Keep what is being tried, as a step with a model file. Raises SysidError where nothing is."""
        with self._change() as state:
            if state.trial is None:
                raise SysidError(
                    "nothing is being tried; expected an effect or a value: switch one on, or drag one"
                )
            self._commit(self._kept(state, state.trial))

    def take_back(self) -> None:
        """Forget what is being tried; else go back by one step. Raises SysidError at the beginning."""
        with self._change() as state:
            if state.trial is not None:
                self._commit(replace(state, trial=None))
            elif state.at == 0:
                raise SysidError("this is the first step; there is nothing to take back")
            else:
                self._go(state, state.at - 1)

    def go_to(self, number: int) -> None:
        """Undo and redo: make another step of the history the current one. Raises SysidError where there is none."""
        with self._change() as state:
            if not 0 <= number < len(state.steps):
                raise SysidError(f"there is no step {number}; expected 0 to {len(state.steps) - 1}")
            self._go(replace(state, trial=None), number)

    def suggest(self, progress: Progress = silent) -> None:
        """Look for the runs that would best tell the likeliest explanations apart. Raises SysidError undiagnosed."""
        with self._change() as state:
            self._commit(replace(state, suggestions=acts.suggestions(state, self.pool, progress)))

    def export(self, folder: Path | None = None, progress: Progress = silent) -> list[Path]:
        """Write model, report, figures and the script that does it all again; returns their paths."""
        with self._change() as state:
            return export(state, folder or self.folder / "export", self.reading, self.pool, progress)

    def model_file(self) -> Path:
        """A file with the model that is shown, for the running simulator; before any run, the one to begin with."""
        path = self.folder / "shown.yaml"
        self.folder.mkdir(parents=True, exist_ok=True)
        save_model(self.model(), path)
        return path

    def model(self) -> Model:
        """The model that is shown; before any run, the one to begin with."""
        state = self.state
        return state.shown.model if state.steps else chosen_model(self._asked, ())[1]

    def dismiss(self) -> None:
        """Forget the banners that were read."""
        with self._change() as state:
            self._commit(replace(state, banners=()))

    def cards(self) -> list[Card]:
        """Of all effects, the likeliest first. Raises SysidError before any run was loaded."""
        state = self.state
        ranked = state.diagnosis if state.diagnosed <= state.at else None
        return cards(state.shown.model, ranked, self.effects)

    def predict(self, run: str, values: Mapping[str, float]) -> Prediction:
        """What changed values of what is shown would do, by its derivatives."""
        state = self.state
        return predicted(state.shown, state.number_of(run), values)

    def true(
        self, run: str, values: Mapping[str, float] | None = None, shapes: bool = True
    ) -> "Future[Simulation]":
        """The simulation of one run with the model shown and these values, in a process of its own."""
        state = self.state
        model = state.shown.model.with_values(dict(values or {}))
        return self.hand.submit(simulate, model, state.every[state.number_of(run)].run, (), shapes)

    def _take(self, recordings: Sequence[Recording], unseen: bool, progress: Progress) -> None:
        state = self.state
        model = state.current.model if state.steps else chosen_model(self._asked, recordings)[1]
        known, found, said = checked(model, recordings, state.every)
        state = state.with_banners(said)
        self._commit(state)
        if not found:
            return
        first = len(state.experiments)
        fitted = tuple(known[:first]) if unseen else (*known[:first], *found)
        others = (*known[first:], *found) if unseen else tuple(known[first:])
        state = replace(state, experiments=fitted, unseen=others)
        self._commit(self._judged_anew(state, model, progress) if fitted else state)

    def _regroup(
        self,
        state: SessionState,
        fitted: Sequence[Experiment],
        unseen: Sequence[Experiment],
        progress: Progress,
    ) -> None:
        if not fitted:
            raise SysidError("no run to fit would be left; expected one at least: load another one first")
        state = replace(state, experiments=tuple(fitted), unseen=tuple(unseen))
        self._commit(self._judged_anew(state, state.current.model, progress))

    def _judged_anew(self, state: SessionState, model: Model, progress: Progress) -> SessionState:
        """All steps against the runs there are now; what was said of fewer is forgotten."""
        state = replace(state, trial=None, diagnosis=None, suggestions=())
        if not state.steps:
            first = with_amplitudes(model, state.every)
            return self._kept(state, acts.evaluated(state, "start", first, self.pool, progress, ()))
        steps = []
        for number, step in enumerate(state.steps):
            progress(f"{step.label} against all runs", number / len(state.steps))
            again = acts.evaluated(state, step.label, step.model, self.pool, silent, step.did)
            steps.append(replace(again, file=step.file))
        return replace(state, steps=tuple(steps))

    def _kept(self, state: SessionState, step: Step) -> SessionState:
        """With one more step, whose label is numbered where another one is called so already."""
        taken = [each.label for each in state.kept]
        labels = chain([step.label], (f"{step.label} ({number})" for number in count(2)))
        label = next(each for each in labels if each not in taken)
        new = replace(step, label=label, file=self._ledger.keep(replace(step, label=label)))
        new.__dict__["comparison"] = step.comparison  # what was worked out stays
        return state.with_step(new)

    def _go(self, state: SessionState, number: int) -> None:
        what = "taken back" if number < state.at else "restored"
        self._ledger.note(what, state.steps[max(number, state.at)])
        self._commit(replace(state, at=number))

    @contextmanager
    def _change(self) -> Iterator[SessionState]:
        if not self._changing.acquire(blocking=False):
            raise SysidError("the workbench is at work on something else; wait for it, or cancel it")
        try:
            yield self.state
        finally:
            self._changing.release()

    def _commit(self, state: SessionState) -> None:
        self.state = state
        self.version += 1
