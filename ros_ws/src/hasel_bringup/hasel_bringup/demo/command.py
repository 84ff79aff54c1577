"""`make demo`: fit, compare, watch it live, learn what is missing, add it, watch the error fall."""

import argparse
import os
import sys
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from hasel_muscle import bench_muscle
from hasel_recording import RecordingError, read_recording
from hasel_sysid.command_line import fit, improve, measured_fish
from hasel_sysid.command_line.running import MISLEADING
from hasel_sysid.errors import SysidError
from hasel_sysid.filmed_fish import filmed_runs
from hasel_sysid.report.content import called_as
from rich.console import Console
from rich.markup import escape

from hasel_bringup.demo.live_error import LiveError
from hasel_bringup.demo.measured_bodies import MeasuredBody, found_in
from hasel_bringup.demo.measured_muscle import UNSEEN_VOLTAGES, steps_in
from hasel_bringup.errors import BringupError

_REPLAYED = "val_5200V_2.5Hz.csv"


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
            self._step("A filmed fish: its drive, and its speeds by the forces of the fluid", self._filmed)
        minutes, seconds = divmod(round(time.monotonic() - begun), 60)
        self._console.print(
            f"\nDone in {minutes} min {seconds} s: open {escape(str(self.output / 'report.html'))}"
        )
        self._console.print(f"Go on by hand, in the browser: {escape(self._workbench())}", soft_wrap=True)

    def _workbench(self) -> str:
        """The command that opens these runs in the workbench."""
        folder = self.fitted[0].parent
        runs = f"{folder}/fit_*.csv --validate {folder}/val_*.csv"
        return f"bin/ros2 run hasel_workbench workbench {runs} --output {self.output / 'workbench'}"

    def _step(self, title: str, work: Callable[[], None]) -> None:
        self._console.rule(f"[bold]{escape(title)}", align="left")
        begun = time.monotonic()
        work()
        self._console.print(f"[dim]{time.monotonic() - begun:.0f} s[/dim]\n")

    def _live(self, *models: Path) -> None:
        frames = int(read_recording(self.replayed).valid.sum())
        domain = 1 + os.getpid() % 100
        with LiveError(models[0], self.output, domain) as live:
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

    def _filmed(self) -> None:
        _call(measured_fish, [str(self.fish), "--output", str(self.output / "fish")])


def _runs(paths: Sequence[Path]) -> str:
    return "one run" if len(paths) == 1 else f"{len(paths)} runs"


def _files(folder: Path, pattern: str) -> list[Path]:
    files = sorted(folder.glob(pattern))
    if not files:
        raise BringupError(
            f"there is no {pattern} in {folder}; name the folder that holds it (from the clone's root)"
        )
    return files


def _call(command, arguments: Sequence[str]) -> None:
    """Run one of the commands as a user would; what it says of misleading recordings is enough.

    Raises BringupError when it fails.
    """
    name = command.__name__.rpartition(".")[2]
    with called_as("hasel_sysid", name, *arguments):
        code = command.main(arguments)
    if code not in (0, MISLEADING):
        raise BringupError(f"{name} failed with exit code {code}; see its message above")


def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code."""
    try:
        Demo(options.data, options.body, options.output, options.muscle, options.fish).run()
    except (BringupError, RecordingError, SysidError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0
