"""Which effects go on from one round to the next."""

from dataclasses import dataclass, field, replace
from types import SimpleNamespace

import pytest
from hasel_sysid.diagnosis import search as module
from hasel_sysid.diagnosis.search import search, search_from_larger


@dataclass(frozen=True, eq=False)
class FakeTrial:
    """As far as the search looks at one."""

    start: SimpleNamespace
    sum_of_squares: float
    predicted: float
    promised: float


@dataclass
class FakeTrials:
    """Twelve effects that promise a tenth, one that promises nothing, and one whose first try is far off.

    Its second finds the truth.
    """

    moved: list = field(default_factory=list)
    fitted: SimpleNamespace = field(default_factory=lambda: SimpleNamespace(sum_of_squares=1.0))

    def time_is_over(self):
        """Never."""
        return False

    def first(self, starts):
        """By name."""
        kinds = {"far": (12.0, 1.5, 0.3), "hopeless": (12.0, 1.5, 0.01)}
        return [FakeTrial(start, *kinds.get(start.effect.id, (1.0, 0.9, 0.1))) for start in starts]

    def further(self, trials):
        """One step on."""
        self.moved += [t.start.effect.id for t in trials]
        return [
            replace(t, sum_of_squares=0.1, predicted=0.05, promised=0.95) if t.start.effect.id == "far" else t
            for t in trials
        ]


@pytest.fixture(autouse=True)
def _no_sizes(monkeypatch):
    monkeypatch.setattr(module, "resized", lambda start, by: start)


def test_a_first_try_far_off_gets_a_second(monkeypatch):
    """What promises less than nothing from far away is not dropped for it."""
    monkeypatch.setattr(module, "starts", _one_start)
    best, first = search(FakeTrials(), _effects("far"))
    assert best[0].start.effect.id == "far"
    assert (len(best), len(first)) == (13, 13)


def test_what_could_remove_next_to_nothing_gets_no_further_step(monkeypatch):
    """An effect whose change and derivatives point elsewhere than the residual is not simulated again."""
    monkeypatch.setattr(module, "starts", _one_start)
    trials = FakeTrials()
    best, _ = search(trials, _effects("hopeless"))
    assert "weak_0" in trials.moved and "hopeless" not in trials.moved
    assert len(best) == 13


def test_what_could_remove_far_less_than_the_best_is_no_rival(monkeypatch):
    """Once one effect is found that removes nearly all, those that could remove a tenth stay where they are."""
    monkeypatch.setattr(module, "starts", _one_start)
    trials = FakeTrials()
    search(trials, _effects("far"))
    assert trials.moved[9:] == ["far", "far"]


def test_larger_sizes_are_tried_of_what_has_hope(monkeypatch):
    """And the best one comes first; where nothing is one-sided there are none."""
    monkeypatch.setattr(module, "starts", _one_start)
    monkeypatch.setattr(module, "larger_starts", _one_start)
    best, _ = search(FakeTrials(), [*_effects("far"), SimpleNamespace(id="hopeless")])
    larger = [trial.start.effect.id for trial in search_from_larger(FakeTrials(), best, worth=0.05)]
    assert larger[0] == "far" and "hopeless" not in larger and len(larger) == 13
    monkeypatch.setattr(module, "larger_starts", lambda effect: [])
    assert search_from_larger(FakeTrials(), best, worth=0.05) == []


@dataclass
class HeavyAndStiff(FakeTrials):
    """What is far too heavy at its size looks promising at a quarter of it; what is too stiff cannot be simulated."""

    promised: float = 0.3

    def first(self, starts):
        """By size."""
        kinds = {1.0: (12.0, 2.8, self.promised), 0.5: (3.0, 1.5, 0.3), 0.25: (1.2, 0.2, 0.8)}
        simulated = [s for s in starts if s.effect.id != "stiff" or s.values["size"] < 1.0]
        return [FakeTrial(start, *kinds[start.values["size"]]) for start in simulated]


def test_what_starts_far_off_is_tried_at_half_its_size_and_at_a_quarter(monkeypatch):
    """As what cannot be simulated at its typical size; the trials at that come first, for the signatures."""
    monkeypatch.setattr(module, "starts", lambda effect: [_sized(effect, 1.0)])
    monkeypatch.setattr(module, "resized", lambda start, by: _sized(start.effect, by * start.values["size"]))
    best, first = search(HeavyAndStiff(), [SimpleNamespace(id="heavy"), SimpleNamespace(id="stiff")])
    assert [(t.start.effect.id, t.start.values["size"]) for t in first] == [
        ("heavy", 1.0),
        ("heavy", 0.5),
        ("stiff", 0.5),
        ("heavy", 0.25),
        ("stiff", 0.25),
    ]
    assert [t.start.values["size"] for t in best] == [0.25, 0.25]


def test_what_could_remove_little_from_far_off_is_not_tried_nearer(monkeypatch):
    """Its change looks like nothing in the residual."""
    monkeypatch.setattr(module, "starts", lambda effect: [_sized(effect, 1.0)])
    monkeypatch.setattr(module, "resized", lambda start, by: _sized(start.effect, by * start.values["size"]))
    _, first = search(HeavyAndStiff(promised=0.1), [SimpleNamespace(id="heavy")])
    assert len(first) == 1


def test_what_has_no_size_is_not_tried_twice(monkeypatch):
    """A signed effect starts at its null."""
    monkeypatch.setattr(module, "starts", lambda effect: [_sized(effect, 1.0)])
    monkeypatch.setattr(module, "resized", lambda start, by: start)
    _, first = search(HeavyAndStiff(), [SimpleNamespace(id="heavy")])
    assert len(first) == 1


def _sized(effect, size):
    return SimpleNamespace(effect=effect, values={"size": size}, changes_nothing=False)


def _one_start(effect):
    return [SimpleNamespace(effect=effect, values={}, changes_nothing=False)]


def _effects(last: str) -> list[SimpleNamespace]:
    return [SimpleNamespace(id=f"weak_{number}") for number in range(12)] + [SimpleNamespace(id=last)]
