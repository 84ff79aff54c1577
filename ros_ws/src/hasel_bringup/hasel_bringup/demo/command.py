"""`make demo`: fit, compare, watch it live, learn what is missing, add it, watch the error fall."""

import argparse
import os
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from hasel_recording import RecordingError, read_recording
from hasel_sysid.command_line import fit, improve
from rich.console import Console
from rich.markup import escape

from hasel_bringup.demo.live_error import LiveError
from hasel_bringup.errors import BringupError

_DATA = Path("data") / "unseen_rig" / "quadratic_drag"
_REPLAYED = "val_5200V_2.5Hz.csv"


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="demo", description=__doc__.partition(": ")[2])
    parser.add_argument(
        "--data",
        type=Path,
        default=_DATA,
        metavar="DIR",
        help="fit_*.csv and val_*.csv (default: %(default)s)",
    )
    parser.add_argument(
        "--beam", type=Path, metavar="DIR", help="also gravity_a.csv and gravity_b.csv of a measured beam"
    )
    parser.add_argument(
        "--output", type=Path, default=Path("output") / "demo", metavar="DIR", help="(default: %(default)s)"
    )
    return parser


class Demo:
    """The steps in order; each tells what it does and how long it took."""

    def __init__(self, data: Path, beam: Path | None, output: Path) -> None:
        self.fitted, self.unseen = _files(data, "fit_*.csv"), _files(data, "val_*.csv")
        self.replayed = data / _REPLAYED if (data / _REPLAYED) in self.unseen else self.unseen[-1]
        self.beam = None if beam is None else (*_files(beam, "gravity_a.csv"), *_files(beam, "gravity_b.csv"))
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
        if self.beam:
            self._step("Fit the measured beam to one run, compare on another", self._beam)
        minutes, seconds = divmod(round(time.monotonic() - begun), 60)
        self._console.print(
            f"\nDone in {minutes} min {seconds} s: open {escape(str(self.output / 'report.html'))}"
        )

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

    def _beam(self) -> None:
        """The beam's model is a bare elastic one: what its rubber does besides is to be found."""
        seen, unseen = map(str, self.beam)
        _call(
            improve,
            [seen, "--validate", unseen, "--model", "beam", "--output", str(self.output / "beam")],
        )


def _files(folder: Path, pattern: str) -> list[Path]:
    files = sorted(folder.glob(pattern))
    if not files:
        raise BringupError(
            f"there is no {pattern} in {folder}; name the folder that holds it (from the clone's root)"
        )
    return files


def _call(command, arguments: Sequence[str]) -> None:
    """Run one of the commands as a user would. Raises BringupError when it fails."""
    code = command.main(arguments)
    if code:
        raise BringupError(
            f"{command.__name__.rpartition('.')[2]} failed with exit code {code}; see its message above"
        )


def main() -> int:
    """Command line of `demo`; returns the exit code."""
    arguments = _parser().parse_args()
    try:
        Demo(arguments.data, arguments.beam, arguments.output).run()
    except (BringupError, RecordingError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
