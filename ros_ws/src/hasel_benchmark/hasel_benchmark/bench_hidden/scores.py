"""All outcomes in numbers, beside the bars."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from hasel_benchmark.bench_hidden.outcome import Outcome
from hasel_benchmark.bench_hidden.share import wilson_interval

CORES_OF_THE_TIME_BARS = 2


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
        if self.least is not None and self.most is not None:
            return f"{self._text(self.least)}–{self._text(self.most)}"
        if self.least is None and self.most is None:
            return "–"
        return f"≥ {self._text(self.least)}" if self.most is None else f"≤ {self._text(self.most)}"

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


def is_seen(o: Outcome) -> bool:
    """Whether one effect of the catalogue is hidden, and to be seen."""
    return o.kind == "single" and o.visible


def _strong(o: Outcome) -> bool:
    return o.kind == "strong" and o.visible


def _both(o: Outcome) -> bool:
    return o.kind == "pair" and o.visible


def _explicable(o: Outcome) -> bool:
    return is_seen(o) or _both(o)


def _unlisted(o: Outcome) -> bool:
    return o.kind == "unlisted" and o.visible


def _faulty(o: Outcome) -> bool:
    return o.kind == "set_up"


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
    Line("a fault of the set-up hidden: named", _faulty, lambda o: o.fault_named, least=0.95),
    Line("… and what is beside it exactly as it is", _faulty, lambda o: o.fault_named and o.exact),
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
    sizes = [o.group_size for o in seen]
    covered = [e.covered for o in explicable if o.all_named for e in o.estimates if e.covered is not None]
    removed = (
        ("fitted", [o.removed_fitted for o in explicable], 0.95),
        ("unseen", [o.removed_unseen for o in explicable], 0.9),
    )
    return [
        *(share_of(line, answered) for line in LINES),
        Bar(
            "size of the stated group (mean)",
            float(np.mean(sizes)) if sizes else None,
            None,
            None,
            len(seen),
            "",
        ),
        _share("95 % intervals that cover the truth", covered, least=0.93, most=0.97),
        *(
            _median(f"excess error removed, {which} runs (median)", own, least=bar)
            for which, own, bar in removed
        ),
        *_times(answered),
    ]


def share_of(line: Line, outcomes: Iterable[Outcome]) -> Bar:
    """Of the cases that a line is about, how many it holds for."""
    return _share(line.what, [line.holds(o) for o in outcomes if line.among(o)], line.least, line.most)


def _times(outcomes: Sequence[Outcome]) -> list[Bar]:
    """How long `improve` took, by the number of cores that it had; the bars are for two."""
    found = []
    for cores in sorted({o.cores for o in outcomes}):
        barred = cores == CORES_OF_THE_TIME_BARS
        own = [o for o in outcomes if o.cores == cores]
        hard = [o.seconds for o in own if o.kind in ("pair", "unlisted")]
        words = f"time of one improve on {cores} core{'s' if cores > 1 else ''}"
        found.append(
            _median(f"{words} (median)", [o.seconds for o in own], most=40 if barred else None, unit="s")
        )
        tail = float(np.percentile(hard, 95)) if hard else None
        found.append(
            Bar(
                f"{words}, pairs and effects of no catalogue (95th percentile)",
                tail,
                None,
                150 if barred else None,
                len(hard),
                "s",
            )
        )
        longest = max(o.seconds for o in own)
        found.append(Bar(f"{words} (longest)", longest, None, None, len(own), "s"))
    return found


def _share(
    what: str, held: Sequence[bool | None], least: float | None = None, most: float | None = None
) -> Bar:
    if not held:
        return Bar(what, None, least, most, 0)
    share = float(np.mean(held))
    return Bar(what, share, least, most, len(held), interval=wilson_interval(share, len(held)))


def _median(
    what: str,
    values: Iterable[float],
    least: float | None = None,
    most: float | None = None,
    unit: str = "%",
) -> Bar:
    finite = [value for value in values if np.isfinite(value)]
    return Bar(what, float(np.median(finite)) if finite else None, least, most, len(finite), unit)


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
