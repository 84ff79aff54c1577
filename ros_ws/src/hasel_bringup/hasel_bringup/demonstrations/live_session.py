# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The live loop: measure, learn what is missing, add it, measure again, open the secret."""

import json
import os
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from hasel_common.yaml_text import read_yaml
from hasel_interfaces.srv import AddEffect, LoadModel
from hasel_sim.model import load_model
from hasel_sim.parameter import value_with_error
from hasel_sysid.command_line.running import MISLEADING
from rich.console import Console
from rich.markup import escape
from std_srvs.srv import SetBool

from hasel_bringup.errors import BringupError
from hasel_bringup.experimenter import Experimenter, ExperimentFailedError
from hasel_bringup.hidden_truth.plan import FITTED, UNSEEN, BoxRun
from hasel_bringup.processes import Processes

_NICENESS = 10  # of the commands: the supply must not be held up
_REST_S = 0.3
_PERIODS = 2
_ATTEMPTS = 5
_DRAWING_S = 1800.0
_WATCHED = BoxRun(5200.0, 2.5, unseen=True)
_RIVALS = 4  # effects between which the further run is to decide
_WHOLE_S = 360.0  # as long as it should take
_AFTER_S = 100.0  # of it for what comes after the search
_LEAST_S = 300.0  # for the search, however busy the machine: cut shorter it may not come to the effect


class Session:
    """The steps in order; each tells what it does, and how long it took."""

    def __init__(self, rig: Experimenter, processes: Processes, folder: Path, console: Console) -> None:
        self._rig, self._processes, self._folder, self._console = rig, processes, folder, console
        self._begun = time.monotonic()

    def run(self, runs: int | None = None) -> None:
        """The whole loop, or only the `runs` shortest runs. Raises BringupError when a step fails."""
        planned = (
            (*FITTED, *UNSEEN) if runs is None else sorted(FITTED, key=lambda run: -run.frequency)[:runs]
        )
        self._step("The nodes find each other", self._get_ready)
        recordings: list[Path] = []
        self._step(
            f"Measure {_count(planned)}; the error of the model as it comes is live on {self._rig.error_topic}",
            lambda: recordings.extend(self._measure(run.name, _goal(run)) for run in planned),
        )
        if runs is None:
            self._learn(recordings)
        self._step("The secret is opened", self._open)
        minutes, seconds = divmod(round(time.monotonic() - self._begun), 60)
        self._say(f"Done in {minutes} min {seconds} s; everything is in {self._folder}.")

    def _learn(self, recordings: Sequence[Path]) -> None:
        fitted = [path for path in recordings if path.name.startswith("fit_")]
        unseen = [path for path in recordings if path.name.startswith("val_")]
        with self._rig.resting():
            self._step("Learn what is missing (improve)", lambda: self._improve(fitted, unseen))
            self._step("Which run would tell more (suggest)", lambda: self._suggest(fitted))
        self._rig.await_nodes()
        self._step("Watch the error live, before and after", self._watch)
        if self._goal_file.is_file():
            self._step("One more run", lambda: self._measure("suggested", self._goal()))

    def _command(self, name: str, *arguments: str) -> None:
        """Run a command of hasel_sysid, as a user types it, and show for how long it has been working."""
        self._processes.start("hasel_sysid", name, *arguments)
        os.setpriority(os.PRIO_PROCESS, self._processes.process_id(name), _NICENESS)
        begun = time.monotonic()
        with self._console.status("") as status:
            while not self._processes.ended(name):
                status.update(f"{name} has been working for {time.monotonic() - begun:.0f} s")
                time.sleep(0.1)
        code = self._processes.finish(name, 1.0)
        if code not in (0, MISLEADING):
            raise BringupError(f"{name} failed with exit code {code}; see {self._processes.output(name)}")

    def _get_ready(self) -> None:
        self._rig.await_nodes()
        self._say(self._rig.trigger("camera/speed"))
        self._say("The supply is armed for each run only.")

    def _measure(self, name: str, goal: dict[str, Any]) -> Path:
        """One run, one recording; returns its path. A run that fails is kept beside and made again."""
        for attempt in range(1, _ATTEMPTS + 1):
            try:
                return self._attempt(name, goal, f"{name}_{attempt}")
            except ExperimentFailedError as error:
                path = Path(self._rig.trigger("recorder/stop"))
                kept = path.rename(path.with_name(f"{name}_failed_{attempt}.mcap"))
                self._say(f"{name}: {error}; kept as {kept.name}, the run is made again.")
        raise BringupError(f"{name} failed {_ATTEMPTS} times; is this machine too busy?")

    def _attempt(self, name: str, goal: dict[str, Any], supply_name: str) -> Path:
        rig, periods = self._rig, goal["periods"]
        if cleared := rig.arm():
            self._say(f"The supply had stopped itself: {cleared} It was cleared and armed again.")
        rig.trigger("hasel_tracker/restart")
        rig.set_parameters("hasel_recorder", {"name": name})
        path = Path(rig.trigger("recorder/start"))
        before = rig.measured
        rig.trigger("camera/capture", SetBool, data=True)
        supply = str(self._folder / "supply" / supply_name)
        duration = periods / goal["frequency"] + 2 * _REST_S
        rig.run_experiment({**goal, "rest_time": _REST_S, "output": supply}, duration)
        rig.trigger("disarm")
        pictures = int(rig.trigger("camera/capture", SetBool, _DRAWING_S, data=False).split()[0])
        lost = rig.await_frames(pictures, before)
        rig.trigger("recorder/stop")
        said = f", {lost} of them lost" if lost else ""
        self._say(
            f"{name:24} {pictures:4} pictures{said}: live mean |Δ sin θ| = {rig.error.mean_absolute_error:.4f}"
        )
        return path

    def _improve(self, fitted: Sequence[Path], unseen: Sequence[Path]) -> None:
        left = _WHOLE_S - _AFTER_S - (time.monotonic() - self._begun)
        self._command(
            "improve",
            *map(str, fitted),
            "--validate",
            *map(str, unseen),
            *("--output", str(self._folder)),
            *("--json", str(self._folder / "improve.json")),
            *("--seconds", f"{max(left, _LEAST_S):.0f}"),
        )
        found = self._found()
        for stage in found["stages"]:
            effects = " + ".join(stage["effects"]) or "fitted, nothing added"
            self._say(
                f"{effects}: fitted runs {stage['mae_fit']:.4f}, unseen runs {stage['mae_validation']:.4f}"
            )
        self._say(f"verdict: {found['verdict']['status']}; report: {self._folder / 'report.html'}")
        if not_tried := found["verdict"]["not_tried"]:
            self._say(f"In the time for this demonstration not tried: {', '.join(not_tried)}.")

    def _found(self) -> dict[str, Any]:
        return json.loads((self._folder / "improve.json").read_text(encoding="utf-8"))

    def _watch(self) -> None:
        """The same drive under the fitted baseline, and after the found effects were added to the running simulator."""
        rig = self._rig
        baseline = json.loads((self._folder / "ledger.jsonl").read_text(encoding="utf-8").splitlines()[0])
        rig.trigger("load_model", LoadModel, model=str((self._folder / baseline["model"]).resolve()))
        self._measure("live_before", _goal(_WATCHED, periods=4))
        before = rig.error.mean_absolute_error
        improved = load_model(self._folder / "improved_model.yaml")
        if not improved.effects:
            self._say("Nothing was found missing, so nothing is added.")
            return
        for effect in self._found()["stages"][-1]["effects"]:
            self._say(rig.trigger("add_effect", AddEffect, effect=effect))
        values = {f"parameters.{p.name}": float(p.value) for p in improved.parameters.values()}
        rig.set_parameters("hasel_simulator", values)
        self._measure("live_after", _goal(_WATCHED, periods=4))
        self._say(f"The live error went from {before:.4f} to {rig.error.mean_absolute_error:.4f}.")

    @property
    def _goal_file(self) -> Path:
        return self._folder / "suggested_run.yaml"

    def _suggest(self, fitted: Sequence[Path]) -> None:
        ranking = [entry["effect"] for entry in self._found()["ranking"]]
        rivals = list(dict.fromkeys([*self._found()["stages"][-1]["effects"], *ranking]))[:_RIVALS]
        if len(rivals) < 2:
            self._say("No two explanations are left between which a run could decide.")
            return
        self._command(
            "suggest", *map(str, fitted), "--effects", ",".join(rivals), "--output", str(self._folder)
        )
        goal = self._goal()
        self._say(
            f"To tell {', '.join(rivals)} apart: {goal['waveform']} of {goal['voltage']:g} V at "
            f"{goal['frequency']:g} Hz, {goal['periods']} periods, muscles {goal['muscles']}"
        )

    def _goal(self) -> dict[str, Any]:
        goal = read_yaml(self._goal_file.read_text(encoding="utf-8"))
        return {**goal, "voltage": float(goal["voltage"]), "frequency": float(goal["frequency"])}

    def _open(self) -> None:
        hidden = self._rig.trigger("camera/reveal")
        self._say(f"hidden: {hidden}")
        if (self._folder / "improve.json").is_file():
            self._say(f"found:  {_in_words(self._found())}")

    def _step(self, title: str, work: Callable[[], object]) -> None:
        self._console.rule(f"[bold]{escape(title)}", align="left")
        begun = time.monotonic()
        work()
        self._console.print(f"[dim]{time.monotonic() - begun:.0f} s[/dim]\n")

    def _say(self, sentence: str) -> None:
        self._console.print(escape(sentence), highlight=False)


def _goal(run: BoxRun, periods: int = _PERIODS) -> dict[str, Any]:
    return {"voltage": run.voltage, "frequency": run.frequency, "periods": periods, "waveform": "box"}


def _count(planned: Sequence[BoxRun]) -> str:
    unseen = sum(run.unseen for run in planned)
    runs = "one run" if len(planned) == 1 else f"{len(planned) - unseen} runs"
    return f"{runs} and {unseen} that the fit will not see" if unseen else runs


def _in_words(found: dict[str, Any]) -> str:
    stage = found["stages"][-1]
    parts = [
        f"{name} = {value_with_error(parameter['value'], parameter['std'], parameter['unit'])}"
        for name, parameter in stage["parameters"].items()
        if name.partition(".")[0] in stage["effects"] and parameter["std"] is not None
    ]
    return ", ".join(parts) or ", ".join(stage["effects"]) or "nothing missing"
