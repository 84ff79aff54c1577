"""The ledger of an improvement: one model file per stage, so that each step can be taken back."""

import json
from pathlib import Path

from hasel_sim.model import save_model

from hasel_sysid.improve import Stage

LEDGER_FILE = "ledger.jsonl"


class Ledger:
    """Writes every stage as soon as it is known.

    path: the ledger, one JSON object per line: stage, effects, model file, errors, and what the diagnosis said.
    """

    def __init__(self, folder: Path) -> None:
        self.folder, self.path = folder, folder / LEDGER_FILE
        self.stages: list[Stage] = []

    def add(self, stage: Stage) -> None:
        """Write a stage's model file and its line in the ledger; the first one starts a new ledger."""
        self.folder.mkdir(parents=True, exist_ok=True)
        number = len(self.stages)
        name = "+".join((f"stage_{number}", *(stage.effects[-1:]))) + ".yaml"
        save_model(stage.fit.model, self.folder / name)
        line = {
            "stage": number,
            "effects": list(stage.effects),
            "model": name,
            "mae_fit": stage.mae_fit,
            "mae_validation": stage.mae_validation,
            "parameters": {n: p.value for n, p in stage.fit.model.parameters.items()},
            "evidence": None if stage.diagnosis is None else str(stage.diagnosis.best),
        }
        with self.path.open("a" if self.stages else "w", encoding="utf-8") as file:
            file.write(json.dumps(line, ensure_ascii=False) + "\n")
        self.stages.append(stage)
