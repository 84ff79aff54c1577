"""The commands `improve` and `diagnose` from end to end, on a coarse model with a hidden effect."""

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from hasel_recording import Recording, write_recording
from hasel_sim.drive.voltage import VoltageSchedule
from hasel_sim.model import load_model, save_model
from hasel_sim.run import Run
from hasel_sim.simulate import simulate
from hasel_sysid.command_line import improve

COARSE = {"mesh_density": 0.5, "quadrature_order": 2, "steps_per_second": 120.0}
TRUTH = {"mesh_density": 0.8, "quadrature_order": 2, "steps_per_second": 480.0, "spectral_radius": 1.0}
VALUES = {"amplitude_3500": 0.027, "amplitude_5500": 0.062, "slope": 0.3}
CONDITIONS = ((3500.0, 1.0), (3500.0, 2.0), (5500.0, 1.0), (5500.0, 2.0), (4500.0, 1.5))
OWN = '''
import numpy as np
from hasel_sim.effects.base import EffectParameter, ForceEffect


class WaveDrag(ForceEffect):
    """Drag that grows with the third power of the normal velocity."""

    id = "wave_drag"
    physics = "Waves carry energy away from the moving surface."
    equation = "f = -c |v.n|^2 (v.n) n per skin length"
    parameters = (EffectParameter("coefficient", "c", "N s^3/m^5", 0.0, 0.0, 1e5, 500.0),)
    sites = "skin"
    depends_on = ("velocity",)

    def force(self, at, p):
        speed = np.sum(at.velocity * at.rest_normal, axis=1)
        return (-p.coefficient * speed**3)[:, None] * at.rest_normal
'''


@dataclass(frozen=True)
class Laboratory:
    """Where the recordings and the model without the effect lie."""

    folder: Path
    effect: str

    def improve(self, output: Path, rivals: str) -> dict:
        """The content of `improve --json`: four runs fitted, one unseen."""
        fitted = sorted(str(path) for path in self.folder.glob("[35]*V*.csv"))
        arguments = [*fitted, "--validate", str(self.folder / "4500V_1.5Hz.csv")]
        arguments += ["--model", str(self.folder / "coarse.yaml"), "--effects", f"{self.effect},{rivals}"]
        arguments += ["--jobs", "1", "--output", str(output), "--json", str(output / "i.json")]
        assert improve.main(arguments) == 0
        return json.loads((output / "i.json").read_text())


def laboratory(folder: Path, effect: str, values: dict[str, float]) -> Laboratory:
    """Record a swimmer with an effect, on another mesh and with other time steps than the model's."""
    coarse = load_model("swimmer").with_numerics(**COARSE)
    save_model(coarse, folder / "coarse.yaml")
    truth = load_model("swimmer").with_numerics(**TRUTH).with_levels(np.array([3500.0, 5500.0]))
    truth = truth.with_effects(effect).with_values({**VALUES, **values})
    for seed, (voltage, frequency) in enumerate(CONDITIONS):
        frames = np.arange(0, 2 / frequency, 1 / 120)
        side = np.mod(frames * frequency, 1) < 0.5
        drive = voltage * np.column_stack([side, ~side])
        angle = simulate(truth, Run("r", frames, VoltageSchedule(frames, drive))).sin_theta
        noise = 0.002 * np.random.default_rng(seed).normal(size=len(frames))
        name = f"{voltage:.0f}V_{frequency:g}Hz"
        write_recording(Recording(name, frames, angle + noise, drive), folder / f"{name}.csv")
    return Laboratory(folder, effect)


@pytest.fixture(scope="module")
def with_drag(tmp_path_factory) -> Laboratory:
    """A swimmer in a liquid that the model leaves out."""
    return laboratory(tmp_path_factory.mktemp("drag"), "quadratic_drag", {"quadratic_drag.coefficient": 0.25})


@pytest.fixture(scope="module")
def with_waves(tmp_path_factory) -> Laboratory:
    """A swimmer with an effect that stands in no catalogue but in a file of the user's."""
    folder = tmp_path_factory.mktemp("waves")
    (folder / "wave_drag.py").write_text(OWN)
    return laboratory(folder, f"{folder}/wave_drag.py:WaveDrag", {"wave_drag.coefficient": 400.0})


def test_improve_adds_the_hidden_effect(with_drag, tmp_path, capsys):
    """The drag is named, added with its value, and the error falls to the noise on fitted and unseen runs."""
    content = with_drag.improve(tmp_path, "muscle_asymmetry")
    assert content["verdict"]["status"] == "explained"
    assert content["verdict"]["missing"] == ["quadratic_drag"]
    first, last = content["stages"][0], content["stages"][-1]
    drag = last["parameters"]["quadratic_drag.coefficient"]
    assert drag["value"] == pytest.approx(0.25, rel=0.03)
    assert last["mae_fit"] < 0.002 < 0.1 * first["mae_fit"]
    assert last["mae_validation"] < 0.002
    assert content["where_it_fails"]
    assert content["start"]["mae_fit"] > first["mae_fit"]
    assert "Missing: quadratic_drag" in (tmp_path / "report.html").read_text(encoding="utf-8")
    assert load_model(tmp_path / "improved_model.yaml").effects[0].id == "quadratic_drag"
    lines = [json.loads(line) for line in (tmp_path / "ledger.jsonl").read_text().splitlines()]
    assert [line["effects"] for line in lines] == [[], ["quadratic_drag"]]
    for line in lines:
        load_model(tmp_path / line["model"])
    assert {"waterfall.png", "error_by_stage.png"} <= {path.name for path in tmp_path.iterdir()}
    assert "quadratic_drag is missing" in capsys.readouterr().out


def test_improve_adds_an_effect_of_the_users_own(with_waves, tmp_path):
    """An effect from a file of the user's is ranked, added, fitted and written to the model like the built-in ones."""
    content = with_waves.improve(tmp_path, "muscle_asymmetry,linear_drag")
    assert content["ranking"][0]["effect"] == "wave_drag"
    assert content["verdict"]["missing"] == ["wave_drag"]
    first, last = content["stages"][0], content["stages"][-1]
    assert last["mae_validation"] < 0.002 < 0.2 * first["mae_validation"]
    improved = load_model(tmp_path / "improved_model.yaml")
    assert improved.effects[0].id == "wave_drag"
    assert improved.values["wave_drag.coefficient"] == pytest.approx(400.0, rel=0.1)
