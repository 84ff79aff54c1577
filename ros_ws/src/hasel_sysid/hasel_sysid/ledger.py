"""A file per stage and a ledger of all, so that every acceptance can be looked up and taken back."""

import json
from pathlib import Path

from hasel_sim.model import save_model

from hasel_sysid.result import Stage


class Ledger:
    """Writes `stage_<n>_<effects>.yaml` and one line of `ledger.jsonl` for every stage as soon as it is known."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.path = folder, folder / "ledger.jsonl"
        self.path.write_text("")
        self._count = 0

    def add(self, stage: Stage) -> None:
        """Write a stage's model and what was found there."""
        name = "_".join([f"stage_{self._count}", *(stage.added or ("baseline",))]) + ".yaml"
        save_model(stage.fit.model, self.folder / name)
        self._count += 1
        best = None if stage.diagnosis is None else stage.diagnosis.best
        line = {
            "model": name,
            "effects": list(stage.effects),
            "constant": stage.constant or None,
            "mae_fit": stage.mae_fit,
            "mae_validation": stage.mae_validation,
            "next": None if best is None else {"effect": best.effect, "finding": str(best)},
        }
        with self.path.open("a") as file:
            file.write(json.dumps(line, ensure_ascii=False) + "\n")
