# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`bench`: accuracy, robustness, honesty, speed and latency of the tracker against drawn truth, beside the bars."""

import argparse
import json
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from hasel_common.measured_bar import MeasuredBar
from hasel_tracker.errors import TrackerError, run_command
from rich.console import Console
from rich.table import Table

from hasel_tracker_lab.bench.accuracy import CONDITIONS, Accuracy, measure_accuracy
from hasel_tracker_lab.bench.honesty import Honesty, measure_honesty
from hasel_tracker_lab.bench.robustness import CASES, Robustness, measure_robustness
from hasel_tracker_lab.bench.tracker_speed import Latency, TrackerSpeed, measure_latency, measure_speed
from hasel_tracker_lab.scenes.scene_catalogue import ADVERSARIAL, MIDLINE, REAL
from hasel_tracker_lab.scenes.unforeseen import DECEIVING, UNFORESEEN

CSRT_FRAMES = 12
LAB_SEEDS, DRAWN_SEEDS, DECEIVING_SEEDS = 10, 3, 20
LEAST_FRAMES = 30


@dataclass(frozen=True)
class BenchReport:
    """All results of the benchmark."""

    accuracies: list[Accuracy]
    csrt: Accuracy
    robustness: list[Robustness]
    honesty: list[Honesty]
    deceiving: list[Honesty]
    speed: TrackerSpeed
    latency: Latency

    def bars(self) -> list[MeasuredBar]:
        """The figures that have a bar."""
        by_name = {each.condition: each for each in self.accuracies}
        worst = {name: float(each.marker_rms_px.max()) for name, each in by_name.items()}
        rest = by_name["at rest, MJPEG 75"]
        return [
            MeasuredBar("clean: worst marker (px rms)", worst["clean"], 0.02),
            MeasuredBar("MJPEG quality 75: worst marker (px rms)", worst["MJPEG quality 75"], 0.05),
            MeasuredBar("noise of sin θ at rest", rest.sin_theta_spread, 0.001),
            MeasuredBar("frames/s, one core, without decoding", self.speed.tracking_hz, 300.0, at_least=True),
            MeasuredBar(
                "false angles in the robustness cases", sum(each.false_angles for each in self.robustness), 0
            ),
            MeasuredBar(
                "wrong while valid in the laboratory's scenes", sum(each.wrong for each in self.honesty), 0
            ),
            MeasuredBar(
                "wrong while valid in the scenes that deceive", sum(each.wrong for each in self.deceiving), 0
            ),
            MeasuredBar("latency from capture to angle (ms, median)", 1e3 * self.latency.median_s, 50.0),
            MeasuredBar("frames late to recover", sum(each.late_frames for each in self.robustness), 0),
        ]

    def print(self, console: Console) -> None:
        """Print the tables."""
        console.print(
            self._accuracy_table(),
            _honesty_table("Laboratory scenes of another renderer, 1280 × 720", self.honesty),
            _honesty_table("Scenes that deceive, 1280 × 720", self.deceiving),
            self._robustness_table(),
            self._bars_table(),
        )
        console.print(f"Speed at 1080p, one core: {self.speed}")
        console.print(f"Latency at 1080p: {self.latency}")

    def values(self) -> dict[str, Any]:
        """Everything as plain values, for JSON."""
        return {
            "accuracies": [_plain(each) for each in self.accuracies],
            "csrt": _plain(self.csrt),
            "robustness": [_plain(each) for each in self.robustness],
            "honesty": [_plain(each) for each in self.honesty],
            "deceiving": [_plain(each) for each in self.deceiving],
            "speed": _plain(self.speed),
            "latency": _plain(self.latency),
            "bars": [_plain(each) | {"met": bool(each.met)} for each in self.bars()],
        }

    def _accuracy_table(self) -> Table:
        table = Table(title="Distance from the truth (px rms) and error of sin θ, 1080p")
        for heading in ("condition", "head", "middle", "tail", "sin θ rms", "sin θ spread", "lost"):
            table.add_column(heading, justify="left" if heading == "condition" else "right")
        for each in (*self.accuracies, self.csrt):
            pixels = [f"{value:.4f}" for value in each.marker_rms_px]
            angle = [f"{each.sin_theta_rms:.1e}", f"{each.sin_theta_spread:.1e}"]
            table.add_row(each.condition, *pixels, *angle, f"{100 * each.lost_share:.0f} %")
        return table

    def _robustness_table(self) -> Table:
        table = Table(title="Robustness")
        for heading in ("case", "frames", "marker unseen", "false angles", "frames late"):
            table.add_column(heading, justify="left" if heading == "case" else "right")
        for each in self.robustness:
            numbers = (each.frames, each.unseen_frames, each.false_angles, each.late_frames)
            table.add_row(each.case, *(str(number) for number in numbers))
        return table

    def _bars_table(self) -> Table:
        table = Table(title="Bars")
        for heading in ("what", "measured", "bar", "met"):
            table.add_column(heading, justify="left" if heading == "what" else "right")
        for each in self.bars():
            sign = "≥" if each.at_least else "≤"
            table.add_row(
                each.what, f"{each.measured:.4g}", f"{sign} {each.limit:g}", "yes" if each.met else "NO"
            )
        return table


def _honesty_table(title: str, results: list[Honesty]) -> Table:
    table = Table(title=title)
    for heading in (
        "scene",
        "frames",
        "px rms",
        "sin θ rms",
        "σ of sin θ said",
        "lost",
        "wrong while valid",
    ):
        table.add_column(heading, justify="left" if heading == "scene" else "right")
    for each in results:
        table.add_row(
            each.case, str(each.frames), _shown(each.rms_px, ".3f"), _shown(each.sin_theta_rms, ".1e"),
            _shown(each.sin_theta_std, ".1e"), _shown(100 * each.lost_share, ".0f", " %"), str(each.wrong),
        )  # fmt: skip
    return table


def run_bench(frames: int, told: Callable[[str], None]) -> BenchReport:
    """Run everything; `told` is given a sentence after each part."""
    speed = measure_speed()
    told(f"Speed: {speed}")
    latency = measure_latency()
    told(f"Latency: {latency}")
    accuracies = []
    for condition in CONDITIONS:
        accuracies.append(measure_accuracy(condition, frames))
        told(str(accuracies[-1]))
    csrt = measure_accuracy(CONDITIONS[2], CSRT_FRAMES, "csrt")
    csrt = Accuracy(f"CSRT, {csrt.condition}", *(getattr(csrt, name) for name in list(asdict(csrt))[1:]))
    told(str(csrt))
    robustness = []
    for case in CASES:
        robustness.append(measure_robustness(case, frames))
        told(str(robustness[-1]))
    honesty = []
    for case in (*ADVERSARIAL, *UNFORESEEN, *REAL, *MIDLINE):
        seeds = LAB_SEEDS if case in ADVERSARIAL else DRAWN_SEEDS if case in UNFORESEEN else 1
        honesty.append(measure_honesty(case, max(case.least_frames, frames // 3), seeds))
        told(str(honesty[-1]))
    deceiving = [measure_honesty(case, case.least_frames, DECEIVING_SEEDS) for case in DECEIVING]
    for each in deceiving:
        told(str(each))
    return BenchReport(accuracies, csrt, robustness, honesty, deceiving, speed, latency)


def _shown(value: float, form: str, unit: str = "") -> str:
    return "–" if np.isnan(value) else f"{value:{form}}{unit}"


def _plain(result: Any) -> dict[str, Any]:
    return {
        key: np.asarray(value).tolist() if isinstance(value, (np.ndarray, np.generic)) else value
        for key, value in asdict(result).items()
    }


def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code: 0 if every bar is met, 2 if not."""
    missed: list[str] = []
    return run_command(lambda: _bench(options, missed)) or (2 if missed else 0)


def _bench(options: argparse.Namespace, missed: list[str]) -> None:
    if options.frames < LEAST_FRAMES:
        raise TrackerError(f"{options.frames} frames are too few; give at least {LEAST_FRAMES}.")
    progress = Console(stderr=True)
    report = run_bench(options.frames, lambda sentence: progress.print(sentence, style="dim"))
    report.print(Console(width=110))
    if options.json is not None:
        options.json.write_text(json.dumps(report.values(), indent=1))
    missed.extend(bar.what for bar in report.bars() if not bar.met)
