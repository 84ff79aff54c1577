"""The session as a Python script that does it all again."""

from collections.abc import Mapping, Sequence
from itertools import groupby
from pathlib import Path

from hasel_sysid.errors import SysidError
from hasel_sysid.experiment import Experiment

from hasel_workbench.recordings import ReadingChoices
from hasel_workbench.state import SessionState

START_FILE, AGAIN_FILE = "start.yaml", "model_again.yaml"

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
    paths = [_path(each) for each in experiments]
    parts = [*(f"        {str(path)!r}," for path in paths)]
    if columns:
        parts.append(f"        columns={columns!r},")
    drives = [reading.drives.get(str(each.recording.path)) for each in experiments]
    if any(drives):
        parts.append(f"        drives={[None if d is None else str(Path(d).resolve()) for d in drives]!r},")
    return "h.load(\n" + "\n".join(parts) + "\n    )"


def _path(experiment: Experiment) -> Path:
    path = experiment.recording.path
    if path is None:
        raise SysidError(f"{experiment.name} is in no file, so no script can read it again; save it first")
    return path.resolve()
