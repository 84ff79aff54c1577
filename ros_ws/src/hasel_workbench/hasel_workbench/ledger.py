"""A model file for every step and a line for everything that was done, so that nothing that was kept is ever lost."""

import json
import re
from datetime import datetime
from pathlib import Path

from hasel_sim.model import save_model

from hasel_workbench.step import Step


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
