# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`make demo`: fit, compare, watch it live, learn what is missing, add it, watch the error fall."""

import argparse
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from types import ModuleType

from diagnostic_msgs.msg import DiagnosticArray
from hasel_common.endpoints import Role, subscription
from hasel_common.topics import DIAGNOSTICS, ERROR, SIMULATED
from hasel_interfaces.msg import RunningError
from hasel_interfaces.srv import LoadModel
from hasel_muscle import bench_muscle
from hasel_recording import read_recording
from hasel_sysid.command_line import fit, improve, measured_fish
from hasel_sysid.command_line.running import MISLEADING
from hasel_sysid.filmed_fish import filmed_runs
from hasel_sysid.report.content import called_as
from rich.console import Console
from rich.markup import escape

from hasel_bringup.errors import BringupError
from hasel_bringup.experimenter import Experimenter
from hasel_bringup.processes import ALONE, OWN_DOMAIN, Processes

_REPLAYED = "val_5200V_2.5Hz.csv"
_PATIENCE_S = 60.0
STEPS = "*step*.mat"
PLACES = (".", "raw_data", "post_process/raw_data")
UNSEEN_VOLTAGES = (1000, 2500, 4000, 5500, 7000)
"""Every third of the voltages, 0.5 to 8 kV, that the public recording lifts at."""


@dataclass(frozen=True)
class MeasuredBody:
    """name: of its results' folder; model: that it is compared with; fitted and unseen: files of the folder."""

    name: str
    model: str
    fitted: tuple[str, ...]
    unseen: tuple[str, ...]

    def files(self, folder: Path) -> tuple[list[Path], list[Path]] | None:
        """The fitted and the unseen files; None where the folder does not hold all of them."""
        fitted, unseen = ([folder / name for name in names] for names in (self.fitted, self.unseen))
        return (fitted, unseen) if all(path.is_file() for path in (*fitted, *unseen)) else None


MEASURED_BODIES = (
    MeasuredBody("beam", "beam", ("gravity_a.csv",), ("gravity_b.csv",)),
    MeasuredBody("loaded_beam", "beam", ("load52_a.csv",), ("load52_b.csv",)),
    MeasuredBody(
        "arm",
        "arm",
        tuple(f"step_{pressure}mbar.csv" for pressure in (100, 200, 300, 400)),
        ("step_250mbar.csv",),
    ),
)


def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code."""
    try:
        Demo(options.data, options.body, options.output, options.muscle, options.fish).run()
    except KeyboardInterrupt:
        return 130
    return 0


class Demo:
    """The steps in order; each tells what it does and how long it took."""

    def __init__(
        self,
        data: Path,
        bodies: Sequence[Path],
        output: Path,
        muscle: Path | None = None,
        fish: Path | None = None,
    ) -> None:
        self.fitted, self.unseen = _files(data, "fit_*.csv"), _files(data, "val_*.csv")
        self.replayed = data / _REPLAYED if (data / _REPLAYED) in self.unseen else self.unseen[-1]
        self.bodies = found_in(list(bodies))
        self.lifts = [] if muscle is None else steps_in(muscle)
        self.fish = fish
        if fish is not None:
            filmed_runs(fish)  # refuses a folder without films before anything takes time
        self.output = output
        output.mkdir(parents=True, exist_ok=True)
        self._console = Console(highlight=False)

    def run(self) -> None:
        """All steps. Raises BringupError when one fails."""
        begun = time.monotonic()
        recordings = [*map(str, self.fitted), "--validate", *map(str, self.unseen)]
        self._step(
            f"Fit the swimmer to {len(self.fitted)} runs, compare on {len(self.unseen)} it has not seen",
            lambda: _call(fit, [*recordings, "--output", str(self.output / "fit")]),
        )
        fitted = self.output / "fit" / fit.MODEL_FILE
        self._step(f"Replay {self.replayed.name} through the nodes", lambda: self._live(fitted))
        self._step(
            "Learn what is missing, add it, fit again",
            lambda: _call(
                improve,
                [*recordings, "--output", str(self.output), "--json", str(self.output / "improve.json")],
            ),
        )
        improved = self.output / improve.MODEL_FILE
        self._step(
            f"Replay {self.replayed.name} again, with both models", lambda: self._live(fitted, improved)
        )
        for body, fitted, unseen in self.bodies:
            self._step(
                f"A measured body: fit the {body.name.replace('_', ' ')} to {_runs(fitted)}, judge on {_runs(unseen)}",
                partial(self._measured, body, fitted, unseen),
            )
        if self.lifts:
            self._step("A measured muscle on its bench, judged on voltages that were not fitted", self._bench)
        if self.fish is not None:
            filmed = [str(self.fish), "--output", str(self.output / "fish")]
            self._step(
                "A filmed fish: its drive, and its speeds by the forces of the fluid",
                lambda: _call(measured_fish, filmed),
            )
        minutes, seconds = divmod(round(time.monotonic() - begun), 60)
        self._console.print(
            f"\nDone in {minutes} min {seconds} s: open {escape(str(self.output / 'report.html'))}"
        )
        folder = self.fitted[0].parent
        runs = f"{folder}/fit_*.csv --validate {folder}/val_*.csv"
        workbench = f"bin/ros2 run hasel_workbench workbench {runs} --output {self.output / 'workbench'}"
        self._console.print(f"Go on by hand, in the browser: {escape(workbench)}", soft_wrap=True)

    def _step(self, title: str, work: Callable[[], None]) -> None:
        self._console.rule(f"[bold]{escape(title)}", align="left")
        begun = time.monotonic()
        work()
        self._console.print(f"[dim]{time.monotonic() - begun:.0f} s[/dim]\n")

    def _live(self, *models: Path) -> None:
        frames = int(read_recording(self.replayed).valid.sum())
        with LiveError(models[0], self.output) as live:
            for model in models:
                live.load(model)
                error = live.of(self.replayed, frames)
                self._console.print(
                    f"{model.stem}: the nodes end at mean |Δ sin θ| = {error:.4f} over {frames} frames in real time"
                )

    def _measured(self, body: MeasuredBody, fitted: list[Path], unseen: list[Path]) -> None:
        """The model is a bare one: what the real body does besides is to be found."""
        recordings = [*map(str, fitted), "--validate", *map(str, unseen)]
        _call(improve, [*recordings, "--model", body.model, "--output", str(self.output / body.name)])

    def _bench(self) -> None:
        unseen = ["--unseen-voltages", ",".join(map(str, UNSEEN_VOLTAGES))]
        _call(bench_muscle, [*map(str, self.lifts), *unseen, "--output", str(self.output / "muscle")])


def _runs(paths: Sequence[Path]) -> str:
    return "one run" if len(paths) == 1 else f"{len(paths)} runs"


def _files(folder: Path, pattern: str) -> list[Path]:
    files = sorted(folder.glob(pattern))
    if not files:
        raise BringupError(
            f"there is no {pattern} in {folder}; name the folder that holds it (from the clone's root)"
        )
    return files


def _call(command: ModuleType, arguments: Sequence[str]) -> None:
    """Run one of the commands as a user would; what it says of misleading recordings is enough.

    Raises BringupError when it fails.
    """
    name = command.__name__.rpartition(".")[2]
    with called_as("hasel_sysid", name, *arguments):
        code = command.main(arguments)
    if code not in (0, MISLEADING):
        raise BringupError(f"{name} failed with exit code {code}; see its message above")


def found_in(folders: list[Path]) -> list[tuple[MeasuredBody, list[Path], list[Path]]]:
    """Bodies whose recordings lie in the folders or in folders within them, with their fitted and unseen files.

    Raises BringupError for a folder that holds none.
    """
    found = []
    for folder in folders:
        places = [folder, *sorted(path for path in folder.glob("*") if path.is_dir())]
        here = [
            (body, *files) for place in places for body in MEASURED_BODIES if (files := body.files(place))
        ]
        if not here:
            known = "; ".join(", ".join((*body.fitted, *body.unseen)) for body in MEASURED_BODIES)
            raise BringupError(
                f"there is no measured body in {folder}; expected one of these sets of recordings: {known}"
            )
        found += here
    return found


def steps_in(folder: Path) -> list[Path]:
    """Recordings of steps in a clone of the public repository, or in its folder of raw data.

    Raises BringupError for a folder that holds none.
    """
    found = [path for place in PLACES for path in sorted((folder / place).glob(STEPS))]
    if not found:
        raise BringupError(
            f"there is no {STEPS} in {folder}, nor in its {PLACES[-1]}; expected a clone of the public repository "
            "MadhavL/PH-HASEL-Python: name its folder"
        )
    return found


class LiveError:
    """The error that simulator, identification and replay come to, as three processes on DDS.

    As a context manager, starts simulator and identification; `of` replays a recording through them.
    """

    def __init__(self, model: Path, folder: Path) -> None:
        self._model, self._folder = model.resolve(), folder.resolve()
        self._processes = Processes(folder, ALONE)
        self._connected = False
        self._last, self._compared = RunningError(), 0

    def __enter__(self) -> "LiveError":
        hint = f"; is a firewall between local processes? see {self._processes.output('simulator')}"
        self._rig = Experimenter(self._processes.check, OWN_DOMAIN, "hasel_demo", hint)
        subscription(self._rig.node, RunningError, ERROR, self._on_error, Role.EVERY_SAMPLE)
        subscription(self._rig.node, DiagnosticArray, DIAGNOSTICS, self._on_diagnostics, Role.DIAGNOSTICS)
        model = ("--ros-args", "-p", f"model:={self._model}")
        self._processes.start("hasel_sim", "simulator", *model, "-p", f"own_files:={self._folder}")
        self._processes.start("hasel_sysid", "sysid", *model)
        try:
            self._rig.until(
                lambda: self._connected, _PATIENCE_S, "simulator and sysid did not find each other"
            )
        except BringupError:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self._processes.__exit__()
        self._rig.close()

    def load(self, model: Path) -> None:
        """Let the running simulator go on with another model. Raises BringupError when it refuses."""
        answer = self._rig.call(LoadModel, "load_model", _PATIENCE_S, model=str(model.resolve()))
        if not answer.success:
            raise BringupError(answer.message)

    def of(self, recording: Path, frames: int) -> float:
        """Mean |Δ sin θ| over the frames of a recording, as published at its last frame."""
        self._compared = 0
        listeners = ("--expect", "hasel_simulator", "hasel_sysid")
        self._processes.start("hasel_bringup", "replay", str(recording), *listeners)
        failure = f"not all {frames} frames were compared"
        self._rig.until(lambda: self._compared == frames, _PATIENCE_S, failure)
        self._processes.finish("replay", _PATIENCE_S)
        return self._last.mean_absolute_error

    def _on_error(self, message: RunningError) -> None:
        self._last, self._compared = message, self._compared + 1

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        for status in message.status:
            values = {pair.key: pair.value for pair in status.values}
            self._connected |= values.get(f"publishers of {SIMULATED}", "0") != "0"
