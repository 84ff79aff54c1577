"""All outcomes in numbers, beside the bars."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from hasel_benchmark.bench_hidden.outcome import Outcome
from hasel_benchmark.bench_hidden.share import wilson_interval

CORES_OF_THE_TIME_BARS = 2
T = TypeVar("T")


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


def bars(outcomes: Sequence[Outcome]) -> list[Bar]:
    """The numbers of all cases that have an answer."""
    answered = [o for o in outcomes if not o.failure]
    nothing, single, strong, pair, unlisted, set_up = (
        [o for o in answered if o.kind == kind]
        for kind in ("nothing", "single", "strong", "pair", "unlisted", "set_up")
    )
    seen, hard = [o for o in single if o.visible], [o for o in single if not o.visible]
    seen_strong = [o for o in strong if o.visible]
    both, seen_unlisted = [o for o in pair if o.visible], [o for o in unlisted if o.visible]
    explicable = [*seen, *both]
    white, coloured = ([o for o in nothing if o.colour == colour] for colour in ("white", "coloured"))
    covered = [e.covered for o in [*seen, *both] if o.all_named for e in o.estimates if e.covered is not None]
    return [
        _share("one visible effect hidden: named first", seen, lambda o: o.right, least=0.95),
        _share("… or within the stated group", seen, lambda o: o.right_within_group, least=0.98),
        _share("… and added to the model", seen, lambda o: o.all_named),
        Bar(
            "… size of the stated group (mean)",
            float(np.mean([o.group_size for o in seen])) if seen else None,
            None,
            None,
            len(seen),
            "",
        ),
        _share("one strong effect hidden: named first", seen_strong, lambda o: o.right, least=0.9),
        _share("… or within the stated group", seen_strong, lambda o: o.right_within_group, least=0.95),
        _share(
            "one effect hidden that leaves hardly a trace: another one accused with confidence",
            hard,
            lambda o: o.accuses_with_confidence and not o.right_within_group,
        ),
        _share(
            "nothing hidden, white noise: something reported", white, lambda o: o.reports_something, most=0.02
        ),
        _share(
            "nothing hidden, coloured noise: something reported",
            coloured,
            lambda o: o.reports_something,
            most=0.02,
        ),
        _share(
            "not in the catalogue: a listed one accused",
            seen_unlisted,
            lambda o: o.accuses_with_confidence,
            most=0.05,
        ),
        _share(
            "… said to be none of them, or not wholly",
            seen_unlisted,
            lambda o: o.says_none_of_them,
            least=0.95,
        ),
        _share("two effects hidden: both named", both, lambda o: o.all_named, least=0.9),
        _share("… or within the stated groups", both, lambda o: o.all_named_within_group, least=0.95),
        _share(
            "one or two effects hidden: exactly these, and nothing beside them",
            explicable,
            lambda o: o.exact,
            least=0.9,
        ),
        _share("a fault of the set-up hidden: named", set_up, lambda o: o.fault_named, least=0.95),
        _share("… and what is beside it exactly as it is", set_up, lambda o: o.fault_named and o.exact),
        _share(
            "no fault of the set-up hidden: one reported",
            [o for o in answered if not o.fault],
            lambda o: bool(o.set_up),
            most=0.02,
        ),
        _share("95 % intervals that cover the truth", covered, bool, least=0.93, most=0.97),
        _median(
            "excess error removed, fitted runs (median)", [o.removed_fitted for o in explicable], least=0.95
        ),
        _median(
            "excess error removed, unseen runs (median)", [o.removed_unseen for o in explicable], least=0.9
        ),
        *_times(answered),
    ]


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
    what: str,
    among: Sequence[T],
    holds: Callable[[T], bool],
    least: float | None = None,
    most: float | None = None,
) -> Bar:
    if not among:
        return Bar(what, None, least, most, 0)
    share = float(np.mean([holds(one) for one in among]))
    return Bar(what, share, least, most, len(among), interval=wilson_interval(share, len(among)))


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
