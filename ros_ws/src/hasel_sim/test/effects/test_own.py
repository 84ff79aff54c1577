# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A user's own effect in one file outside the package."""

import pickle
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hasel_sim.build import Builder
from hasel_sim.drive.chain import DriveChain
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.dynamics.system import linearise
from hasel_sim.effects.registry import catalogue, find_effects
from hasel_sim.errors import ModelError
from hasel_sim.mechanics.state import DriveState, Memory, Motion
from hasel_sim.model import load_model, save_model
from hasel_sim.parallel import executor, simulate_all
from hasel_sim.run import Run
from hasel_sim.simulate import simulate

DOCS = Path(__file__).parents[2] / "docs"
PAGES = Path(__file__).resolve().parents[5] / "docs"
EXAMPLE = DOCS / "examples" / "cross_talk.py"

DRAG = """
import numpy as np
from hasel_sim.effects.base import EffectParameter, ForceEffect


class MyDrag(ForceEffect):
    physics = "Drag along the skin's normal."
    equation = "f = -c abs(v.n) (v.n) n"
    parameters = (EffectParameter("c", "c", "kg/m^3", 0.0, 0.0, 5000.0, 115.0),)
    sites = "skin"
    depends_on = ("velocity", "tangent")

    def force(self, at, p):
        normal = at.normal
        speed = np.sum(at.velocity * normal, axis=1)
        return (-p.c * np.abs(speed) * speed)[:, None] * normal
"""

FIELD_FORCE = """
import numpy as np
from hasel_sim.effects.base import EffectParameter, ForceEffect


class FieldForce(ForceEffect):
    physics = "Charged skin is pulled towards the table's edge while a muscle is contracted."
    equation = "f = (0, k (a_upper + a_lower^2)) x per mass"
    parameters = (EffectParameter("k", "k", "1/s^2", 0.0, 0.0, 1e4, 1e3),)
    depends_on = ("contraction",)

    def force(self, at, p):
        pull = p.k * (at.contraction[0] + at.contraction[1] ** 2) * at.reference[:, 0]
        return np.stack([0 * pull, pull], axis=1)
"""

SLIP = """
from hasel_sim.effects.base import EffectParameter, MaterialEffect
from hasel_sim.mesh.mesh import Region


class FilmViscosity(MaterialEffect):
    physics = "The muscles' film creeps."
    equation = "tension += eta dl/dt"
    parameters = (EffectParameter("eta", "eta", "Pa s", 0.0, 0.0, 1e5, 2e3),)
    regions = (Region.UPPER_MUSCLE, Region.LOWER_MUSCLE)
    depends_on = ("deformation", "rate")

    def first_piola(self, at, p):
        return at.along_fibre(p.eta * at.rate[:, 0, 0])
"""

ROLL = """
from hasel_sim.effects.base import EffectParameter, ObservationEffect


class Zero(ObservationEffect):
    physics = "The camera is turned against the rest line."
    equation = "sin theta += offset"
    parameters = (EffectParameter("offset", "o", "1", 0.0, -0.2, 0.2, 0.02),)

    def angle(self, time, sin_theta, p):
        return sin_theta + p.offset
"""


@pytest.fixture
def written(tmp_path):
    """Write a file of the user's and return `path:Class`."""

    def write(text: str) -> str:
        path = tmp_path / "my_effect.py"
        path.write_text(text)
        return f"{path}:{text.split('class ')[1].split('(')[0]}"

    return write


def test_the_worked_example_is_short_and_in_the_documentation():
    """The example has at most 30 lines and stands word for word in the documentation."""
    text = EXAMPLE.read_text()
    assert len(text.splitlines()) <= 30
    assert text.rstrip() in (PAGES / "how_to" / "effects_of_your_own.md").read_text()


def test_cross_talk_pulls_on_the_resting_muscle(coarse_swimmer, short_boxes):
    """The example: 80 % of 5.5 kV on the muscle at rest contracts it as 4.4 kV would, and the body bends less."""
    model = coarse_swimmer.with_effects(f"{EXAMPLE}:CrossTalk").with_values({"CrossTalk.coupling": 0.8})
    hold = Run("hold", np.array([0.0, 1.0]), DriveSchedule(np.zeros(1), np.array([[5500.0, 0.0]])))
    direct = Run("direct", hold.time, DriveSchedule(np.zeros(1), np.array([[5500.0, 4400.0]])))
    assert simulate(model, hold).sin_theta == pytest.approx(
        simulate(coarse_swimmer, direct).sin_theta, abs=1e-9
    )


@pytest.mark.parametrize(
    "text", [EXAMPLE.read_text(), DRAG, SLIP, ROLL], ids=["drive", "force", "material", "observation"]
)
def test_an_own_effect_is_like_a_built_in_one(
    text, written, coarse_swimmer, coarse_baseline, sin_theta_of, short_boxes
):
    """At any of the four places: null is null, the angle responds, and the sensitivity is that of whole simulations."""
    name = written(text)
    model = coarse_swimmer.with_effects(name)
    (effect,) = model.effects
    parameter = f"{effect.id}.{effect.parameters[0].name}"
    assert np.array_equal(sin_theta_of(model), coarse_baseline)
    typical = effect.parameters[0].typical
    changed = model.with_values({parameter: typical})
    found = simulate(changed, short_boxes, [parameter])
    step = 1e-4 * typical
    more, less = (sin_theta_of(model.with_values({parameter: typical + s})) for s in (step, -step))
    expected = (more - less) / (2 * step)
    assert np.abs(found.sin_theta - coarse_baseline).max() > 1e-4
    assert found.slopes[:, 0] == pytest.approx(expected, abs=1e-3 * np.abs(expected).max())


def test_what_follows_the_contraction_is_differentiated_by_the_amplitude(
    written, coarse_swimmer, sin_theta_of, short_boxes
):
    """A force that depends on the contraction adds to the sensitivity by the baseline's amplitude."""
    model = coarse_swimmer.with_effects(written(FIELD_FORCE)).with_values({"FieldForce.k": 1e3})
    name = "amplitude_5500"
    found = simulate(model, short_boxes, [name]).slopes[:, 0]
    value = model.values[name]
    more, less = (sin_theta_of(model.with_values({name: value + step})) for step in (1e-6, -1e-6))
    assert found == pytest.approx((more - less) / 2e-6, abs=1e-3 * np.abs(found).max())


def test_own_drag_equals_the_built_in_one(written, coarse_swimmer, sin_theta_of):
    """The same law written by a user gives the same trajectory."""
    own = coarse_swimmer.with_effects(written(DRAG)).with_values({"MyDrag.c": 0.5 * 920.0 * 0.25})
    built_in = coarse_swimmer.with_effects("quadratic_drag").with_values({"quadratic_drag.coefficient": 0.25})
    assert sin_theta_of(own) == pytest.approx(sin_theta_of(built_in), abs=1e-9)


def test_a_model_file_names_it_relative_to_itself(written, tmp_path, coarse_swimmer, sin_theta_of):
    """A saved model loads its own effect again, also when both have moved together."""
    model = coarse_swimmer.with_effects(written(DRAG)).with_values({"MyDrag.c": 100.0})
    (tmp_path / "models").mkdir()
    save_model(model, tmp_path / "models" / "model.yaml")
    assert "- ../my_effect.py:MyDrag" in (tmp_path / "models" / "model.yaml").read_text()
    moved = tmp_path / "elsewhere"
    moved.mkdir()
    (tmp_path / "models").rename(moved / "models")
    (tmp_path / "my_effect.py").rename(moved / "my_effect.py")
    tmp_path = moved / "models"
    again = load_model(tmp_path / "model.yaml")
    assert [effect.id for effect in again.effects] == ["MyDrag"]
    assert np.array_equal(sin_theta_of(again), sin_theta_of(model))


def test_it_works_in_other_processes_without_its_file(written, coarse_swimmer, short_boxes, tmp_path):
    """Worker processes simulate with the effect although its file is gone."""
    model = coarse_swimmer.with_effects(written(DRAG)).with_values({"MyDrag.c": 100.0})
    here = simulate(model, short_boxes).sin_theta
    (tmp_path / "my_effect.py").unlink()
    assert pickle.loads(pickle.dumps(model)).effects[0].id == "MyDrag"
    with executor(2) as pool:
        there = simulate_all(pool, model, [short_boxes])[0].sin_theta
    assert there == pytest.approx(here, abs=1e-12)


_CHANGES = {
    "is taken or no plain name": ("    physics =", "    id = 'linear_drag'\n    physics ="),
    "has no physics": ('physics = "Drag along the skin\'s normal."', ""),
    "declares no parameters": ("parameters = (", "others = ("),
    "without unit": ('"kg/m^3"', '""'),
    "outside 1 to 5000": ("0.0, 0.0, 5000.0", "0.0, 1.0, 5000.0"),
    "typically off its null": ("5000.0, 115.0", "5000.0, 0.0"),
    "with null=None, where a number is expected": ("0.0, 0.0, 5000.0", "None, 0.0, 5000.0"),
    "with typical='big', where a number is expected": ("5000.0, 115.0", "5000.0, 'big'"),
    "with scan=115.0, where a tuple of numbers is expected": ("5000.0, 115.0", "5000.0, 115.0, scan=115.0"),
    "has depends_on = 'velocity', where a tuple": ('("velocity", "tangent")', '("velocity")'),
    "use one of body, skin, line, points": ('"skin"', '"everywhere"'),
    "in depends_on": ('("velocity", "tangent")', '("speed", "tangent")'),
    "uses the velocity without saying so": ('("velocity", "tangent")', '("tangent",)'),
    "exerts a force at its null values": ("-p.c", "1 - p.c"),
    "exerts no force at its typical values": ("-p.c", "0 * p.c"),
    "not finite": ("np.abs(speed)", "speed / (p.c - 115.0)"),
    r"returns shape \(7,\) from force where \(7, 2\) is expected": ("[:, None] * normal", ""),
    "depends on others": ("(-p.c", "(-np.mean(speed) * p.c"),
    "fails in force .NameError": ("at.normal", "at_rest"),
    "cannot be run in line 3": ("import EffectParameter, ForceEffect", "import ("),
    "cannot be run .ModuleNotFoundError": ("import numpy", "import nunpy"),
    "is no effect": ("(ForceEffect)", ""),
}


@pytest.mark.filterwarnings("ignore:(divide|invalid):RuntimeWarning")
@pytest.mark.parametrize("said", _CHANGES)
def test_a_broken_effect_is_refused_with_what_to_change(said, written):
    """Null that is not null, no response, wrong shapes, hidden dependencies …: one sentence each."""
    before, after = _CHANGES[said]
    assert before in DRAG
    name = written(DRAG).rpartition(":")[0] + ":MyDrag"
    written(DRAG.replace(before, after).replace("class MyDrag:", "class MyDrag():"))
    with pytest.raises(ModelError, match=said) as caught:
        find_effects((name,))
    assert "\n" not in str(caught.value)
    assert ": " in str(caught.value)


@pytest.mark.parametrize(
    ("text", "before", "after", "said"),
    [
        (
            EXAMPLE.read_text(),
            "signal + p.coupling",
            "2 * signal + p.coupling",
            "changes the signal at its null values",
        ),
        (EXAMPLE.read_text(), "p.coupling * signal[:, ::-1]", "0", "does nothing at its typical values"),
        (EXAMPLE.read_text(), "DriveStage.ELECTRODE", '"electrode"', "use a member of DriveStage"),
        (
            EXAMPLE.read_text(),
            "return signal + p.coupling * signal[:, ::-1]",
            "return signal[:5]",
            r"where .* is expected",
        ),
        (FIELD_FORCE, '("contraction",)', '("position",)', "uses the contraction without saying so"),
        (SLIP, '("deformation", "rate")', '("deformation",)', "uses the rate without saying so"),
        (SLIP, "p.eta *", "1 + p.eta *", "adds stress at its null values"),
        (SLIP, "at.rate[:, 0, 0]", "at.rate[:, 0, 0].mean()", "depends on others|fails in first_piola"),
        (
            EXAMPLE.read_text(),
            "signal[:, ::-1]",
            "__import__('numpy').random.rand(*signal.shape)",
            "other numbers from respond when it is called with the same input again",
        ),
        (
            EXAMPLE.read_text(),
            "signal[:, ::-1]",
            "abs(signal).mean(axis=0)",
            "answers to what is commanded later",
        ),
        (EXAMPLE.read_text(), "p.coupling * signal[:, ::-1]", "0", "driven with 4 strokes of either muscle"),
        (EXAMPLE.read_text(), 'unit="1"', 'unit="bananas"', "in 'bananas', which is no unit"),
        (EXAMPLE.read_text(), "typical=0.4),", "typical=0.4)", "end it with a comma"),
        (ROLL, "p.offset", "p.offset * __import__('random').random()", "other numbers from angle"),
        (ROLL, "p.offset", "p.offset * (sin_theta[-1] - 1)", "shows what is seen later than look_ahead says"),
        (DRAG, "-p.c", "-p.c * np.random.rand()", "other numbers from force"),
        (ROLL, "sin_theta + p.offset", "sin_theta + 0.1", "changes what is observed at its null values"),
        (ROLL, "sin_theta + p.offset", "sin_theta", "does nothing at its typical values"),
    ],
)
def test_other_places_are_checked_alike(text, before, after, said, written):
    """Drive, material and observation effects that break a rule are refused too."""
    assert before in text
    with pytest.raises(ModelError, match=said):
        find_effects((written(text.replace(before, after)),))


TIRING = """
import numpy as np
from hasel_sim.effects.base import DriveEffect, DriveStage, EffectParameter


class Tiring(DriveEffect):
    physics = "Every stroke before the present one weakens a muscle."
    equation = "V <- V (1 - k n)"
    parameters = (EffectParameter("k", "k", "1", 0.0, 0.0, 0.2, 0.05),)
    stage = DriveStage.ELECTRODE

    def respond(self, time, signal, p):
        on = np.abs(signal) > 0
        starts = on & ~np.vstack([np.zeros((1, signal.shape[1]), bool), on[:-1]])
        before = np.maximum(np.cumsum(starts, axis=0) - 1, 0)
        return signal * (1 - p.k * before)
"""


def test_an_effect_that_needs_several_strokes_is_taken(written):
    """It counts the strokes before the present one, so a single stroke of each muscle would show nothing."""
    (effect,) = find_effects((written(TIRING),))
    assert effect.id == "Tiring"


def test_an_id_may_be_declared(written):
    """A class may have an id other than its name."""
    (effect,) = find_effects((written(DRAG.replace("    physics =", '    id = "skin_drag"\n    physics =')),))
    assert effect.id == "skin_drag"
    assert pickle.loads(pickle.dumps(effect)).id == "skin_drag"


def test_missing_files_and_classes_are_named(written):
    """A wrong path or class name is one sentence, with the nearest known class."""
    name = written(DRAG)
    with pytest.raises(ModelError, match=r"there is no file 'nowhere[.]py'"):
        find_effects(("nowhere.py:MyDrag",))
    with pytest.raises(ModelError, match="has no class 'MyDrga'; the nearest known one is 'MyDrag'"):
        find_effects((name.replace(":MyDrag", ":MyDrga"),))
    with pytest.raises(ModelError, match=r"names a file and no class in it; .* write .*my_effect[.]py:CLASS"):
        find_effects((name.removesuffix(":MyDrag"),))


def _median_time(call, repeats: int = 15) -> float:
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    return float(np.median(times))


def test_an_own_drive_effect_is_no_slower_than_three_built_in_ones():
    """The drive chain takes at most 3 times as long with the example as with a built-in effect."""
    (own,) = find_effects((f"{EXAMPLE}:CrossTalk",))
    times = np.linspace(0.0, 4.0, 1920)
    schedule = DriveSchedule(np.zeros(1), np.array([[5500.0, 0.0]]))
    taken = []
    for effect in (catalogue()["muscle_asymmetry"], own):
        model = load_model("swimmer").with_levels(np.array([5500.0])).with_effects(effect.source or effect.id)
        chain, values = DriveChain(replace(model, effects=(effect,))), model.effect_values()
        taken.append(
            _median_time(lambda c=chain, m=model, v=values: c.contraction(schedule, times, m.values, v))
        )
    assert taken[1] < 3 * taken[0]


def test_an_own_force_effect_is_no_slower_than_three_built_in_ones(written):
    """Residual and derivatives take at most 3 times as long with a user's drag as with the built-in one."""
    drive = DriveState.single(np.zeros(2), np.zeros(2), 0.0)
    taken = []
    for name, parameter, value in (
        ("quadratic_drag", "quadratic_drag.coefficient", 0.3),
        (written(DRAG), "MyDrag.c", 100.0),
    ):
        model = load_model("swimmer").with_effects(name).with_values({parameter: value})
        builder = Builder(model)
        system, nodes = builder.system(), builder.mesh.nodes[..., None]
        motion = Motion(nodes, 0.1 * np.ones_like(nodes), np.zeros_like(nodes))

        def force_and_derivatives(system=system, motion=motion):
            system.residual(motion, drive, Memory())
            linearise(system, motion, drive, Memory())

        force_and_derivatives()
        taken.append(_median_time(force_and_derivatives))
    assert taken[1] < 3 * taken[0]


def test_a_file_in_another_encoding_is_refused_or_read_as_it_says(tmp_path):
    """A letter with an accent saved in Latin-1 is no traceback; Python's own line about the encoding is heeded."""
    path = tmp_path / "drag.py"
    path.write_bytes(f"# Trainée\n{DRAG}".encode("latin-1"))
    with pytest.raises(
        ModelError, match=r"drag.py' is no text in UTF-8 .* save it in UTF-8, or name its encoding"
    ):
        find_effects((f"{path}:MyDrag",))
    path.write_bytes(f"# coding: latin-1\n# Trainée\n{DRAG}".encode("latin-1"))
    assert find_effects((f"{path}:MyDrag",))[0].id == "MyDrag"
