"""Which effects go on from one round to the next."""

from dataclasses import dataclass, field, replace
from types import SimpleNamespace

from hasel_sysid.diagnosis import search as module
from hasel_sysid.diagnosis.search import search


@dataclass(frozen=True, eq=False)
class FakeTrial:
    """As far as the search looks at one."""

    start: SimpleNamespace
    sum_of_squares: float
    predicted: float


@dataclass
class FakeTrials:
    """Twelve effects that promise little, and one whose first try is far off; its second finds the truth."""

    fitted: SimpleNamespace = field(default_factory=lambda: SimpleNamespace(sum_of_squares=1.0))

    def first(self, starts):
        """By name."""
        return [
            FakeTrial(start, 12.0, 1.5) if start.effect.id == "far" else FakeTrial(start, 1.0, 0.9)
            for start in starts
        ]

    def further(self, trials):
        """One step on."""
        return [
            replace(t, sum_of_squares=0.1, predicted=0.05) if t.start.effect.id == "far" else t
            for t in trials
        ]


def test_a_first_try_far_off_gets_a_second(monkeypatch):
    """What promises less than nothing from far away is not dropped for it."""
    monkeypatch.setattr(module, "starts", lambda effect: [SimpleNamespace(effect=effect)])
    effects = [SimpleNamespace(id=f"weak_{number}") for number in range(12)] + [SimpleNamespace(id="far")]
    best, first = search(FakeTrials(), effects)
    assert best[0].start.effect.id == "far"
    assert (len(best), len(first)) == (13, 13)
