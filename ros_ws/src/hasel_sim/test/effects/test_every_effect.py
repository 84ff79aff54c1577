# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What holds for every effect in the catalogue, present and future."""

import itertools
import pickle
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sim import effects
from hasel_sim.effects.base import ForceEffect
from hasel_sim.effects.check_effect import check_effect
from hasel_sim.effects.registry import catalogue
from hasel_sim.errors import ModelError
from hasel_sim.model import load_model, save_model
from hasel_sim.simulate import simulate

FOLDERS = [Path(effects.__file__).parent / place for place in ("drive", "material", "force", "observation")]
FILES = sorted(path for folder in FOLDERS for path in folder.glob("[!_]*.py"))
ALL = sorted(catalogue())
ROUND_OFF = 1e-13
"""Of the difference of two series."""
INVISIBLE_IN_THE_ANGLE = {"gravity_tilt"} | {n for n in ALL if catalogue()[n].needs_strained_start}


def _with_typical(model, *identities):
    changed = model.with_effects(*identities)
    values = {
        f"{name}.{key}": value for name in identities for key, value in catalogue()[name].typical().items()
    }
    return changed.with_values(values)


def _central_difference(model, name, sin_theta_of):
    effect = catalogue()[name.partition(".")[0]]
    parameter = next(p for p in effect.parameters if name.endswith(f".{p.name}"))
    value = model.values[name]
    best = []
    for share in (1e-3, 1e-5):
        step = share * abs(parameter.typical)
        above = min(value + step, parameter.upper)
        below = max(value - step, parameter.lower)
        series = [sin_theta_of(model.with_values({name: changed})) for changed in (above, below)]
        best.append(((series[0] - series[1]) / (above - below), ROUND_OFF / (above - below)))
    return best


def test_each_file_holds_one_effect_named_like_it():
    """The registry is filled by the files being there, and an effect's id is its file's name."""
    assert sorted(path.stem for path in FILES) == ALL
    for path in FILES:
        assert catalogue()[path.stem].place == path.parent.name


def test_nothing_outside_its_own_file_acts_on_the_name_of_an_effect():
    """No other module mentions an effect's id, but for the effects themselves and what measures their speed."""
    package = Path(effects.__file__).parent.parent
    for path in package.rglob("*.py"):
        if path not in FILES and path.parent.name != "bench":
            text = path.read_text()
            assert not [name for name in ALL if f'"{name}"' in text], path


def test_each_effect_has_a_test_file():
    """Adding an effect means adding one file and its test."""
    tests = {path.stem.removeprefix("test_") for path in Path(__file__).parent.glob("*/test_*.py")}
    assert set(ALL) <= tests


@pytest.mark.parametrize("identity", ALL)
def test_says_what_it_is(identity):
    """Every statement of a card is there, and the effects it is confused with exist."""
    effect = catalogue()[identity]
    for text in (effect.physics, effect.equation, effect.signature, effect.separated_by, effect.citation):
        assert len(text) > 8
    assert effect.confused_with and set(effect.confused_with) <= set(ALL) - {identity}
    assert all(p.source and p.unit and p.symbol for p in effect.parameters)
    check_effect(effect)


@pytest.mark.parametrize("identity", ALL)
def test_null_is_the_model_without_it(identity, coarse_swimmer, coarse_baseline, sin_theta_of):
    """At its null values the trajectory is bit for bit the one without the effect."""
    assert np.array_equal(sin_theta_of(coarse_swimmer.with_effects(identity)), coarse_baseline)


@pytest.mark.parametrize("identity", [n for n in ALL if catalogue()[n].place in ("force", "material")])
def test_hardly_any_of_it_is_hardly_noticed(identity, coarse_swimmer, coarse_baseline, sin_theta_of):
    """At null an effect is not called; called at a billionth of its size, wherever its scan says, it does as little."""
    model = coarse_swimmer.with_effects(identity)
    effect = catalogue()[identity]
    size = {
        f"{identity}.{p.name}": p.null + 1e-9 * (p.typical - p.null) for p in effect.parameters if not p.scan
    }
    scans = [{f"{identity}.{p.name}": value} for p in effect.parameters for value in p.scan] or [{}]
    for scanned in scans:
        series = sin_theta_of(model.with_values({**size, **scanned}))
        assert np.abs(series - coarse_baseline).max() < 1e-6


@pytest.mark.parametrize("identity", ALL)
def test_typical_values_are_noticed(identity, coarse_swimmer, coarse_baseline, sin_theta_of):
    """At its typical values the angle changes, by more than round-off and less than beyond recognition."""
    change = np.abs(sin_theta_of(_with_typical(coarse_swimmer, identity)) - coarse_baseline).max()
    if identity in INVISIBLE_IN_THE_ANGLE:
        assert change < 2e-6
    else:
        assert 5e-5 < change < 0.7


@pytest.mark.parametrize("identity", ALL)
@pytest.mark.parametrize("at", ["null", "typical"])
def test_sensitivities_agree_with_central_differences(
    identity, at, coarse_swimmer, short_boxes, sin_theta_of
):
    """The derivative by each parameter is that of whole simulations, at null and at typical values."""
    model = coarse_swimmer.with_effects(identity) if at == "null" else _with_typical(coarse_swimmer, identity)
    names = [f"{identity}.{p.name}" for p in catalogue()[identity].parameters]
    slopes = simulate(model, short_boxes, names).slopes
    for column, (name, p) in enumerate(zip(names, catalogue()[identity].parameters, strict=True)):
        expected = _central_difference(model, name, sin_theta_of)
        floor = (1e-5 if identity in INVISIBLE_IN_THE_ANGLE else 1e-7) / abs(p.typical)
        errors = [
            (np.abs(slopes[:, column] - e).max() - own) / (np.abs(e).max() + floor) for e, own in expected
        ]
        assert min(errors) < 1e-3, (name, errors)


@pytest.mark.parametrize("identity", ALL)
def test_travels_to_another_process(identity):
    """An effect survives pickling."""
    assert pickle.loads(pickle.dumps(catalogue()[identity])).id == identity


def test_all_effects_act_together(coarse_swimmer, short_boxes, sin_theta_of):
    """All effects that may stand side by side run in one model, and its sensitivities are right."""
    together = [name for name in ALL if name not in ("camera_latency", "finite_depth_added_mass")]
    model = coarse_swimmer.with_effects(*together)
    tenth = {}
    for name, p in itertools.chain.from_iterable(
        ((n, p) for p in catalogue()[n].parameters) for n in together
    ):
        tenth[f"{name}.{p.name}"] = p.typical if p.scan else p.null + 0.1 * (p.typical - p.null)
    model = model.with_values(tenth)
    names = ["hydraulic_lag.release_time", "structural_damping.loss_factor"]
    slopes = simulate(model, short_boxes, names).slopes
    for column, name in enumerate(names):
        expected = _central_difference(model, name, sin_theta_of)
        errors = [np.abs(slopes[:, column] - e).max() / np.abs(e).max() for e, _ in expected]
        assert min(errors) < 1e-3, (name, errors)


def test_the_order_in_the_model_file_does_not_matter(tmp_path, coarse_swimmer, sin_theta_of):
    """A model file with its effects the other way round gives the same trajectory, bit for bit."""
    names = [
        "structural_damping", "material_damping", "soft_modulus", "pre_bend", "quadratic_drag", "linear_drag",
        "hydraulic_lag", "charge_retention", "charging_lag", "marker_offset", "camera_latency",
    ]  # fmt: skip
    model = _with_typical(coarse_swimmer, *names)
    series = []
    for order in (names, names[::-1]):
        values = {name: value for name, value in model.values.items() if "." in name}
        save_model(coarse_swimmer.with_effects(*order).with_values(values), tmp_path / "model.yaml")
        series.append(sin_theta_of(load_model(tmp_path / "model.yaml")))
    assert np.array_equal(*series)


@pytest.mark.parametrize(
    ("model", "names", "said"),
    [
        ("swimmer", ["linear_drag", "linear_drag"], "is there twice"),
        ("swimmer", ["transport_delay", "camera_latency"], "does the same as 'transport_delay'"),
        ("beam", ["force_length"], "acts on the muscles, and model 'beam' has none"),
        ("beam", ["charging_lag"], "acts on the muscles, and model 'beam' has none"),
        ("beam", ["normal_drag"], "a force of the fluid around the body, and model 'beam' names none"),
        ("beam", ["spine_stiffening"], "acts on the spine, and model 'beam' has none"),
        ("swimmer", ["quadratic_drga"], "nearest known one is 'quadratic_drag'"),
    ],
)
def test_what_cannot_stand_together_is_refused(model, names, said):
    """Duplicates, two delays, and effects on what the body has not, are refused with a sentence."""
    with pytest.raises(ModelError, match=said):
        load_model(model).with_effects(*names)


@pytest.mark.parametrize("identity", [n for n in ALL if isinstance(catalogue()[n], ForceEffect)])
def test_force_effects_never_add_energy(identity, cantilever, extremes):
    """A beam without damping of its own that rings down under a force effect never swings further than before."""
    beam = cantilever()
    _, tip = beam.ring_down(1.2, identity, **catalogue()[identity].typical())
    middle = 0.0 if identity != "gravity_tilt" else 0.5 * (tip.max() + tip.min())
    found = extremes(tip - middle)
    assert len(found) > 0
    assert found.max() < 1.005 * tip[0]
    assert np.all(np.diff(found) < 5e-3 * tip[0])


@pytest.mark.parametrize(
    "identity", [n for n in ALL if getattr(catalogue()[n], "depends_on", ()) == ("velocity",)]
)
def test_brakes_take_power_from_any_motion(identity):
    """A force that depends on velocity alone does negative work on every velocity."""
    rng, effect, n = np.random.default_rng(3), catalogue()[identity], 200
    along = rng.standard_normal((n, 2))
    velocity = 0.3 * rng.standard_normal((n, 2))
    at = SimpleNamespace(velocity=velocity, rest_normal=along / np.linalg.norm(along, axis=1)[:, None])
    power = np.sum(effect.force(at, SimpleNamespace(**effect.typical())) * velocity, axis=1)
    assert np.all(power < 0)
