"""The first ranking, seen from the last stage."""

import importlib
from types import SimpleNamespace

import pytest
from hasel_sysid.improve import Stage
from hasel_sysid.improve import hindsight as module
from hasel_sysid.improve.hindsight import with_hindsight
from hasel_sysid.time_limit import TimeLimit


@pytest.fixture(autouse=True)
def _judged(monkeypatch):
    monkeypatch.setattr(module, "judged", lambda context: context)


def stage(*effects):
    """One whose diagnosis thought of a payload, and takes down what it is told afterwards."""
    found = SimpleNamespace(
        best=SimpleNamespace(effect="payload"),
        context=SimpleNamespace(with_fit=lambda effect, fit: (effect, fit)),
    )
    return Stage(effects, f"fit of {effects}", None, found)


def test_what_a_detour_led_to_is_ranked_with_its_fit():
    """First the payload, then the soft spine, then the spine alone."""
    last = stage("spine_modulus")
    assert with_hindsight([stage(), stage("payload"), last]).diagnosis == ("spine_modulus", last.fit)


@pytest.mark.parametrize("added", [("payload",), ("payload", "spine_modulus"), ("gain_drift", "payload")])
def test_a_first_choice_that_stays_needs_no_second_look(added):
    """And of two effects neither alone was fitted."""
    first = stage()
    assert with_hindsight([first, stage(*added)]) is first


def test_improve_looks_back_when_an_effect_was_added(monkeypatch):
    """The baseline that it hands on is the one ranked again, from the stages known by then."""
    improve = importlib.import_module("hasel_sysid.improve.improve")
    bare, soft = (
        SimpleNamespace(model=SimpleNamespace(effects=effects), evaluation=None)
        for effects in ([], [SimpleNamespace(id="spine_modulus")])
    )
    stubs = {
        "fit_from_afar": bare,
        "in_step": True,
        "diagnose": stage().diagnosis,
        "decide": SimpleNamespace(accepted=stage().diagnosis.best, reason="", negligible=False),
        "_extended": soft,
        "is_noise": True,
        "opposed_runs": [],
    }
    for name, answer in stubs.items():
        monkeypatch.setattr(improve, name, lambda *of, answer=answer: answer)
    monkeypatch.setattr(improve, "_completed", lambda problem, known, on_stage: known)
    monkeypatch.setattr(improve, "_concluded", lambda stages, *why: stages)
    baseline, last = improve.improve(SimpleNamespace(time_limit=TimeLimit()), bare.model)
    assert baseline.diagnosis == ("spine_modulus", last.fit)
