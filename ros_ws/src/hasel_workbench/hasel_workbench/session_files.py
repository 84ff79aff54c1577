# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A session as files: a model and a line for every step; model, report, figures and a script at its end."""

import json
import re
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from datetime import datetime
from itertools import groupby
from pathlib import Path
from typing import Any

from hasel_sim.model import save_model
from hasel_sysid.errors import SysidError
from hasel_sysid.experiment import Experiment
from hasel_sysid.report.content import ReportContent
from hasel_sysid.report.from_improvement import next_run, ranked_rows, what_remains
from hasel_sysid.report.from_results import comparison_content, parameter_rows
from hasel_sysid.report.shape import Shapes, simulated_shapes
from hasel_sysid.report.write import write_report

from hasel_workbench.jobs import Progress
from hasel_workbench.recordings import ReadingChoices
from hasel_workbench.state import SessionState, waterfall
from hasel_workbench.step import Step

START_FILE, MODEL_FILE, AGAIN_FILE, SCRIPT_FILE = "start.yaml", "model.yaml", "model_again.yaml", "session.py"
_MOST_MODELS = 3
"""More models in one curve's picture cannot be told apart: the first and the last ones are shown."""


class StepLedger:
    """Writes `step_<n>_<label>.yaml` and a line of `workbench.jsonl`; what lies in the folder already is kept."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.path = folder, folder / "workbench.jsonl"
        numbers = [re.match(r"step_(\d+)", path.name) for path in folder.glob("step_*.yaml")]
        self._count = max((int(number[1]) + 1 for number in numbers if number), default=0)

    def keep(self, step: Step) -> str:
        """Write a step's model; returns the name of its file."""
        words = re.sub(r"\W+", "_", step.label).strip("_")
        name = f"step_{self._count}_{words}.yaml"
        self.folder.mkdir(parents=True, exist_ok=True)
        save_model(step.model, self.folder / name)
        self._count += 1
        self.note("kept", step, name)
        return name

    def note(self, what: str, step: Step, file: str | None = None) -> None:
        """Write what was done, to which step."""
        line = {
            "time": datetime.now().astimezone().isoformat(timespec="seconds"),
            "what": what,
            "step": step.label,
            "model": file or step.file,
            "effects": list(step.effects),
            "mae_fit": step.error,
            "mae_validation": step.error_unseen,
            "runs": [each.name for each in step.experiments],
        }
        self.folder.mkdir(parents=True, exist_ok=True)
        with self.path.open("a", encoding="utf-8") as file_:
            file_.write(json.dumps(line, ensure_ascii=False) + "\n")


_SCRIPT = '''"""What was done in the workbench, step by step; run it where the workspace is sourced.

Reads {start} beside itself, the model that the session began with, and the recordings named below; writes {again}
beside itself, the model that it ended with.
"""

from pathlib import Path

import hasel_sysid as h

HERE = Path(__file__).resolve().parent


def main() -> None:
    fitted = {fitted}
    unseen = {unseen}
    model = h.model(HERE / "{start}")
    print(h.simulate(model, fitted, unseen, label="start"))
{steps}
    h.save(model, HERE / "{again}")


if __name__ == "__main__":
    main()
'''


def script(state: SessionState, reading: ReadingChoices) -> str:
    """Its text: the steps up to the current one; the first one's model lies beside it."""
    lines: list[str] = []
    for step in state.kept[1:]:
        lines += [*step.did, f"print(h.simulate(model, fitted, unseen, label={step.label!r}))"]
    return _SCRIPT.format(
        fitted=_loaded(state.experiments, reading),
        unseen=_loaded(state.unseen, reading) if state.unseen else "()",
        start=START_FILE,
        again=AGAIN_FILE,
        steps="\n".join(f"    {line}" for line in lines),
    )


def _loaded(experiments: Sequence[Experiment], reading: ReadingChoices) -> str:
    """Recordings that follow one another and whose columns are called alike are read together."""
    alike = groupby(experiments, key=lambda each: dict(reading.of(each.recording.path or "")))
    return " + ".join(_read(list(each), columns, reading) for columns, each in alike)


def _read(experiments: Sequence[Experiment], columns: Mapping[str, str], reading: ReadingChoices) -> str:
    paths = []
    for each in experiments:
        if each.recording.path is None:
            raise SysidError(f"{each.name} is in no file, so no script can read it again; save it first")
        paths.append(each.recording.path)
    parts = [f"        {str(path.resolve())!r}," for path in paths]
    if columns:
        parts.append(f"        columns={columns!r},")
    drives = [reading.drives.get(str(path)) for path in paths]
    if any(drives):
        parts.append(f"        drives={[None if d is None else str(Path(d).resolve()) for d in drives]!r},")
    return "\n".join(["h.load(", *parts, "    )"])


def export(
    state: SessionState, folder: Path, reading: ReadingChoices, pool: Executor, progress: Progress
) -> list[Path]:
    """Write the kept steps; what is being tried is not among them. Returns what was written.

    pool: what is simulated is simulated there.
    """
    from hasel_sysid.report.pictures import overlay_picture, stages_picture, waterfall_picture

    state = replace(state, trial=None)
    folder.mkdir(parents=True, exist_ok=True)
    written = [folder / START_FILE, folder / MODEL_FILE, folder / SCRIPT_FILE]
    save_model(state.steps[0].model, written[0])
    save_model(state.current.model, written[1])
    written[2].write_text(script(state, reading), encoding="utf-8")
    progress("figures", 0.1)
    content = report_content(state, pool)
    for kind in ("svg", "png"):
        written.append(waterfall_picture(content.stages, content.noise_floor, folder / f"waterfall.{kind}"))
        written.append(stages_picture(content.stages, content.noise_floor, folder / f"error_by_step.{kind}"))
        for run in content.runs:
            written.append(overlay_picture([run], folder / f"{run.name}.{kind}"))
    progress("report", 0.6)
    written.append(write_report(content, folder))
    return written


def report_content(state: SessionState, pool: Executor) -> ReportContent:
    """What the report shows of a session."""
    steps = state.kept
    if len(steps) > _MOST_MODELS:
        steps = (steps[0], *steps[1 - _MOST_MODELS :])
    comparisons = [replace(step.comparison, label=step.label) for step in steps]

    def shapes(*given: Any) -> Shapes | None:
        return pool.submit(simulated_shapes, *given).result()

    content = comparison_content(comparisons, detailed=-1, shapes_of=shapes)
    falling, diagnosis, current = waterfall(state), state.diagnosis, state.current
    return replace(
        content,
        title=f"A session of the workbench: {current.label}",
        verdict=str(current),
        good=None,
        stages=falling.stages,
        noise_floor=falling.noise_floor,
        parameters=parameter_rows(current.model, before=state.steps[0].model),
        ranking=() if diagnosis is None else ranked_rows(diagnosis),
        groups=() if diagnosis is None else diagnosis.groups_in_question,
        remains=() if diagnosis is None else what_remains(diagnosis),
        next_runs=tuple(next_run(each) for each in state.suggestions[:3]),
    )
