"""One effect after the other, and two at once where that fails."""

import importlib
from types import SimpleNamespace

import pytest
from hasel_sysid.improve import Status
from hasel_sysid.improve.decision import Decision

module = importlib.import_module("hasel_sysid.improve.improve")
NOISE = 0.0024
PLAIN, WITH_ONE, WITH_TWO = (), ("payload",), ("drag", "delay")


def fit(error, effects):
    """A fit of a model with these effects."""
    model = SimpleNamespace(effects=[SimpleNamespace(id=effect) for effect in effects])
    return SimpleNamespace(mean_absolute_error=error, model=model, evaluation=None)


@pytest.fixture
def improved(monkeypatch):
    """What becomes of a baseline with an error of 0.02: one effect is accepted if it leaves `one`, else none is; a pair
    leaves noise.
    """
    noise = SimpleNamespace(mean_absolute=NOISE)
    found = SimpleNamespace(
        p_value=0.002,
        noise=noise,
        measured=noise,
        best=SimpleNamespace(effect="payload"),
        seen_beside=lambda adequate, added: found,
    )

    def decide(stage, _found):
        if stage.effects == PLAIN and decide.one:
            return Decision(SimpleNamespace(effect="payload"))
        return Decision(None, "None alone.", none_alone=True)

    def run(one=None, most_effects=3):
        decide.one = one
        stubs = {
            "fit_from_afar": fit(0.02, PLAIN),
            "in_step": True,
            "diagnose": found,
            "exchanged": one and fit(one, WITH_ONE),
            "explaining_pair": fit(NOISE, WITH_TWO),
            "most_promised": 1.0,
            "opposed_runs": [],
            "adequacy": SimpleNamespace(adequate=True, misfits=()),
        }
        for name, answer in stubs.items():
            monkeypatch.setattr(module, name, lambda *of, answer=answer: answer)
        monkeypatch.setattr(module, "decide", decide)
        monkeypatch.setattr(module, "without_contradictions", lambda stages: (list(stages), (), []))
        monkeypatch.setattr(module, "pruned", lambda problem, refit, earlier: refit)
        monkeypatch.setattr(module, "_completed", lambda problem, known, on_stage: known)
        monkeypatch.setattr(module, "with_hindsight", lambda stages: stages[0])
        return module.improve(
            SimpleNamespace(experiments=[1, 2]), fit(0.02, PLAIN).model, most_effects=most_effects
        )

    return run


def test_where_no_effect_alone_explains_two_are_added_at_once(improved):
    """And named in one sentence."""
    found = improved()
    assert [stage.effects for stage in found.stages] == [PLAIN, WITH_TWO]
    assert (found.status, found.missing) == (Status.EXPLAINED, WITH_TWO)
    assert found.reason == "What is left after adding drag and delay is noise."


def test_two_take_the_place_of_one_that_explained_nothing(improved):
    """It had been added for a third of the error, and nothing came after it."""
    found = improved(one=0.014)
    assert [stage.effects for stage in found.stages] == [PLAIN, WITH_ONE, WITH_TWO]


def test_what_explains_a_part_keeps_its_place(improved):
    """Three quarters of the error are its."""
    found = improved(one=0.0065)
    assert [stage.effects for stage in found.stages] == [PLAIN, WITH_ONE]
    assert found.status is Status.PARTLY_EXPLAINED


def test_a_search_broken_off_says_so(improved):
    """After its last step something is left, and nobody looked any further."""
    found = improved(one=0.0065, most_effects=1)
    assert [stage.effects for stage in found.stages] == [PLAIN, WITH_ONE]
    assert found.reason == "Step 1 was the last: more effects could imitate anything."
