"""A session as files: model, report, figures and a script."""

from concurrent.futures import Executor
from dataclasses import replace
from pathlib import Path

from hasel_sim.model import save_model
from hasel_sysid.comparison import Comparison
from hasel_sysid.report.content import ReportContent
from hasel_sysid.report.from_improvement import next_run, ranked_rows, what_remains
from hasel_sysid.report.from_results import comparison_content, parameter_rows
from hasel_sysid.report.shape import simulated_shapes
from hasel_sysid.report.write import write_report

from hasel_workbench.evaluate import Progress
from hasel_workbench.recordings import ReadingChoices
from hasel_workbench.script import START_FILE, script
from hasel_workbench.state import SessionState
from hasel_workbench.waterfall import waterfall

MODEL_FILE, SCRIPT_FILE = "model.yaml", "session.py"
_MOST_MODELS = 3
"""More models in one curve's picture cannot be told apart: the first and the last ones are shown."""


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
    comparisons = _shown(state)
    falling = waterfall(state)
    content = comparison_content(
        comparisons, detailed=-1, shapes_of=lambda *given: pool.submit(simulated_shapes, *given).result()
    )
    diagnosis = state.diagnosis
    current = state.current
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


def _shown(state: SessionState) -> list[Comparison]:
    steps = (
        state.kept if len(state.kept) <= _MOST_MODELS else (state.kept[0], *state.kept[1 - _MOST_MODELS :])
    )
    return [replace(step.comparison, label=step.label) for step in steps]
