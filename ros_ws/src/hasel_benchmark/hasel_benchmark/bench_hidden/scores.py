# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""All outcomes in numbers, beside the bars."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

import numpy as np
from scipy.stats import binomtest

from hasel_benchmark.bench_hidden.outcome import Outcome

CORES_OF_THE_TIME_BARS = 2
EDGES = (0.0, 0.2, 0.4, 0.6, 0.8, 0.95, 1.0)
"""Of the bins of stated probabilities."""


@dataclass(frozen=True)
class Bar:
    """One measured number and what it must reach; value None: no case measured it.

    interval: in which a share of so many cases leaves the true one with 95 %; None for what is no share.
    """

    what: str
    value: float | None
    least: float | None
    most: float | None
    cases: int
    unit: str = "%"
    interval: tuple[float, float] | None = None

    @property
    def met(self) -> bool | None:
        """Whether the bar is reached, None when it was not measured or there is none."""
        if self.value is None or (self.least is None and self.most is None):
            return None
        return (self.least is None or self.value >= self.least) and (
            self.most is None or self.value <= self.most
        )

    @property
    def bar(self) -> str:
        """The bar in words."""
        if self.least is None:
            return "–" if self.most is None else f"≤ {self._text(self.most)}"
        if self.most is None:
            return f"≥ {self._text(self.least)}"
        return f"{self._text(self.least)}–{self._text(self.most)}"

    @property
    def measured(self) -> str:
        """The number in words."""
        if self.value is None:
            return "not measured"
        if self.interval is None:
            return self._text(self.value)
        low, high = self.interval
        return f"{self._text(self.value)} ({100 * low:.0f}–{100 * high:.0f})"

    def _text(self, value: float) -> str:
        if self.unit == "%":
            return f"{100 * value:.3g} %"
        return f"{value:.0f} {self.unit}" if self.unit else f"{value:.2g}"


@dataclass(frozen=True)
class Line:
    """A share of cases. among: the cases that it is about; holds: what is counted of them; least, most: its bars."""

    what: str
    among: Callable[[Outcome], bool]
    holds: Callable[[Outcome], bool]
    least: float | None = None
    most: float | None = None


def _visible(*kinds: str) -> Callable[[Outcome], bool]:
    return lambda o: o.kind in kinds and o.visible


is_seen = _visible("single")
"""Whether one effect of the catalogue is hidden, and to be seen."""
_strong, _both, _unlisted = map(_visible, ("strong", "pair", "unlisted"))
_explicable = _visible("single", "pair")
LINES = (
    Line("one visible effect hidden: named first", is_seen, lambda o: o.right, least=0.95),
    Line("… or within the stated group", is_seen, lambda o: o.right_within_group, least=0.98),
    Line("… and added to the model", is_seen, lambda o: o.all_named),
    Line("one strong effect hidden: named first", _strong, lambda o: o.right, least=0.9),
    Line("… strong: or within the stated group", _strong, lambda o: o.right_within_group, least=0.95),
    Line(
        "one effect hidden that leaves hardly a trace: another one accused with confidence",
        lambda o: o.kind == "single" and not o.visible,
        lambda o: o.accuses_with_confidence and not o.right_within_group,
    ),
    Line(
        "nothing hidden, white noise: something reported",
        lambda o: o.kind == "nothing" and o.colour == "white",
        lambda o: o.reports_something,
        most=0.02,
    ),
    Line(
        "nothing hidden, coloured noise: something reported",
        lambda o: o.kind == "nothing" and o.colour == "coloured",
        lambda o: o.reports_something,
        most=0.02,
    ),
    Line(
        "not in the catalogue: a listed one accused",
        _unlisted,
        lambda o: o.accuses_with_confidence,
        most=0.05,
    ),
    Line("… said to be none of them, or not wholly", _unlisted, lambda o: o.says_none_of_them, least=0.95),
    Line("two effects hidden: both named", _both, lambda o: o.all_named, least=0.9),
    Line("… both: or within the stated groups", _both, lambda o: o.all_named_within_group, least=0.95),
    Line(
        "one or two effects hidden: exactly these, and nothing beside them",
        _explicable,
        lambda o: o.exact,
        least=0.9,
    ),
    Line(
        "a fault of the set-up hidden: named",
        lambda o: o.kind == "set_up",
        lambda o: o.fault_named,
        least=0.95,
    ),
    Line(
        "… and what is beside it exactly as it is",
        lambda o: o.kind == "set_up",
        lambda o: o.fault_named and o.exact,
    ),
    Line(
        "no fault of the set-up hidden: one reported",
        lambda o: not o.fault,
        lambda o: bool(o.set_up),
        most=0.02,
    ),
)
"""Every share that is counted, in the order of the page."""


def bars(outcomes: Sequence[Outcome]) -> list[Bar]:
    """The numbers of all cases that have an answer."""
    answered = [o for o in outcomes if not o.failure]
    seen, explicable = ([o for o in answered if among(o)] for among in (is_seen, _explicable))
    covered = [e.covered for o in explicable if o.all_named for e in o.estimates if e.covered is not None]
    return [
        *(
            _share(line.what, [line.holds(o) for o in answered if line.among(o)], line.least, line.most)
            for line in LINES
        ),
        _figure("size of the stated group (mean)", np.mean, [o.group_size for o in seen], unit=""),
        _share("95 % intervals that cover the truth", covered, least=0.93, most=0.97),
        *(
            _figure(f"excess error removed, {which} runs (median)", np.median, own, least)
            for which, own, least in (
                ("fitted", [o.removed_fitted for o in explicable], 0.95),
                ("unseen", [o.removed_unseen for o in explicable], 0.9),
            )
        ),
        *_times(answered),
    ]


def _times(outcomes: Sequence[Outcome]) -> list[Bar]:
    """How long `improve` took, by the number of cores that it had; the bars are for two."""
    found = []
    for cores in sorted({o.cores for o in outcomes}):
        median_s, tail_s = (40, 150) if cores == CORES_OF_THE_TIME_BARS else (None, None)
        own = [o for o in outcomes if o.cores == cores]
        every, hard = [o.seconds for o in own], [o.seconds for o in own if o.kind in ("pair", "unlisted")]
        words = f"time of one improve on {cores} core{'s' if cores > 1 else ''}"
        beyond = f"{words}, pairs and effects of no catalogue (95th percentile)"
        found += [
            _figure(f"{words} (median)", np.median, every, most=median_s, unit="s"),
            _figure(beyond, partial(np.percentile, q=95), hard, most=tail_s, unit="s"),
            _figure(f"{words} (longest)", max, every, unit="s"),
        ]
    return found


def _share(what: str, held: Sequence[bool], least: float | None = None, most: float | None = None) -> Bar:
    if not held:
        return Bar(what, None, least, most, 0)
    interval = wilson_interval(sum(held), len(held))
    return Bar(what, float(np.mean(held)), least, most, len(held), interval=interval)


def wilson_interval(holds: int, count: int) -> tuple[float, float]:
    """In which the true share lies with 95 %, where `holds` of `count` cases hold."""
    low, high = binomtest(holds, count).proportion_ci(method="wilson")
    return float(low), float(high)


def _figure(
    what: str,
    of: Callable[[Sequence[float]], float],
    values: Iterable[float],
    least: float | None = None,
    most: float | None = None,
    unit: str = "%",
) -> Bar:
    finite = [value for value in values if np.isfinite(value)]
    return Bar(what, float(of(finite)) if finite else None, least, most, len(finite), unit)


def confusion(outcomes: Sequence[Outcome]) -> dict[str, dict[str, int]]:
    """Hidden -> named first -> how often, over single, unlisted and nothing-hidden cases."""
    table: dict[str, dict[str, int]] = {}
    for o in outcomes:
        if o.kind in ("pair", "set_up") or o.failure:
            continue
        row = table.setdefault(o.hidden[0] if o.hidden else "nothing", {})
        if o.kind == "unlisted" and o.says_none_of_them and not o.missing:
            named = "none of them"
        else:
            named = o.first or ("none of them" if o.reports_something else "nothing")
        row[named] = row.get(named, 0) + 1
    return table


@dataclass(frozen=True)
class Bin:
    """Answers whose stated probability lies between two edges: how many, its mean, and how many were right."""

    low: float
    high: float
    count: int
    stated: float
    right: int

    @property
    def share(self) -> float:
        """Of right ones."""
        return self.right / self.count

    @property
    def interval(self) -> tuple[float, float]:
        """In which the true share lies with 95 %."""
        return wilson_interval(self.right, self.count)


def reliability(outcomes: Sequence[Outcome]) -> list[Bin]:
    """Bins of the probability of the effect ranked first; where nothing is said to be missing, none was given."""
    answers = [
        (o.probability, o.right)
        for o in outcomes
        if not o.failure and o.kind != "pair" and o.first and np.isfinite(o.probability)
    ]
    found = []
    for low, high in pairwise(EDGES):
        inside = [(p, right) for p, right in answers if low <= p < high or (high == EDGES[-1] and p >= high)]
        if inside:
            stated = float(np.mean([p for p, _ in inside]))
            found.append(Bin(low, high, len(inside), stated, sum(right for _, right in inside)))
    return found
