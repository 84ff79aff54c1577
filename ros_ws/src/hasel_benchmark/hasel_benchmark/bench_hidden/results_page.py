# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The results as a page for readers and as JSON for programs."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
from hasel_bringup.hidden_truth.truth import NUMERICS

from hasel_benchmark.bench_hidden.outcome import Outcome, outcome_from_dict
from hasel_benchmark.bench_hidden.scores import Bar, Bin, bars, confusion, reliability

_LINE = 20
_KEPT_OF_A_BAR = ("what", "value", "least", "most", "met", "interval", "cases")
_WORDS = {True: "yes", False: "**no**", None: ""}


def as_json(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """Bars, confusion matrix and outcomes of every setting of the truth."""
    return {
        name: {
            "bars": [{name: getattr(bar, name) for name in _KEPT_OF_A_BAR} for bar in bars(chosen)],
            "confusion": confusion(chosen),
            "failures": [f"{o.case}: {o.failure}" for o in chosen if o.failure],
            "outcomes": [asdict(o) for o in chosen],
        }
        for name, chosen in _by_numerics(outcomes).items()
    }


def outcomes_of(content: dict[str, Any]) -> dict[str, Outcome]:
    """Read back the outcomes that `as_json` wrote, by the names of their cases."""
    found = [outcome_from_dict(one) for setting in content.values() for one in setting["outcomes"]]
    return {outcome.case: outcome for outcome in found}


def as_markdown(outcomes: Sequence[Outcome], planned: int) -> str:
    """The page; planned: how many cases there are in all."""
    parts = [
        "# Hidden effects: is the right one named?\n",
        "Written by `ros2 run hasel_benchmark bench_hidden`. Each case hides something in a truth of another mesh, "
        "time step, numerical damping and muscle law than the model's, draws the muscles anew within ± 15 %, and adds "
        "noise of 0.003 rms (white, or correlated by 0.9 from frame to frame) and an offset per run. The hidden "
        "effects have the equations of the catalogue, so this tests the naming, not whether the catalogue's "
        "equations are nature's. `improve` sees the nine fitted runs; the three unseen ones only measure.\n",
        "*Visible* means that, once the baseline is fitted, what is left exceeds the noise by at least half its rms; "
        "the rest is swallowed by the fitted parameters, and nothing could name it.\n",
    ]
    if len(outcomes) < planned:
        parts.append(f"**{len(outcomes)} of {planned} cases have been run**; `--resume` runs the rest.\n")
    for name, chosen in _by_numerics(outcomes).items():
        parts += _section(name, chosen)
    return "\n".join(parts)


def _by_numerics(outcomes: Sequence[Outcome]) -> dict[str, list[Outcome]]:
    found = {name: [o for o in outcomes if o.numerics == name] for name in NUMERICS}
    return {name: chosen for name, chosen in found.items() if chosen}


def _section(name: str, outcomes: Sequence[Outcome]) -> list[str]:
    numerics = NUMERICS[name]
    failures = [o for o in outcomes if o.failure]
    return [
        f"## Truth: {name}\n",
        f"Mesh density {numerics.mesh_density:g}, layers {numerics.layers}, "
        f"{numerics.steps_per_second:g} steps/s, spectral radius {numerics.spectral_radius:g}; "
        f"{len(outcomes)} cases, {len(failures)} without an answer.\n",
        _bar_table(bars(outcomes)),
        "### By effect\n",
        _effect_table([o for o in outcomes if o.kind in ("single", "unlisted") and not o.failure]),
        "### Confusion: hidden → named first\n",
        _confusion_list(confusion(outcomes)),
        *_reliability(reliability(outcomes)),
        *([f"Without an answer: {o.case} ({o.failure})\n" for o in failures]),
    ]


def _table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def _bar_table(measured: Sequence[Bar]) -> str:
    rows = [[b.what, b.measured, b.bar, _WORDS[b.met], str(b.cases)] for b in measured]
    return _table(["what", "measured (95 %)", "bar", "met", "out of"], rows)


def _effect_table(outcomes: Sequence[Outcome]) -> str:
    names = list(dict.fromkeys(o.hidden[0] for o in outcomes))
    rows = []
    for name in names:
        all_of_it = [o for o in outcomes if o.hidden[0] == name]
        seen = [o for o in all_of_it if o.visible]
        listed = all_of_it[0].kind == "single"
        shown = ("right", "right_within_group", "all_named")
        rows.append(
            [
                f"`{name}`" + ("" if listed else " (not in the catalogue)"),
                f"{len(seen)} of {len(all_of_it)}",
                *(f"{sum(getattr(o, what) for o in seen)}" if listed else "–" for what in shown),
                _percent([o.removed_fitted for o in seen]),
                _percent([o.removed_unseen for o in seen]),
            ]
        )
    header = ["hidden", "visible", "first", "in group", "added", "removed, fitted", "removed, unseen"]
    return _table(header, rows)


def _percent(shares: Sequence[float]) -> str:
    finite = [share for share in shares if np.isfinite(share)]
    return f"{100 * np.median(finite):.0f} %" if finite else "–"


def _reliability(bins: Sequence[Bin]) -> list[str]:
    if not bins:
        return []
    rows = [
        [
            f"{b.low:.0%}–{b.high:.0%}",
            f"{b.stated:.0%}",
            f"{b.share:.0%} ({b.interval[0]:.0%}–{b.interval[1]:.0%})",
            _line(b),
            str(b.count),
        ]
        for b in bins
    ]
    header = ["called probable", "on average", "right (95 %)", "stated │, right ●", "out of"]
    return [
        "### Reliability: of what is called so probable, how much is right?\n",
        "The effect ranked first where something is said to be missing, pairs aside.\n",
        _table(header, rows),
    ]


def _line(one: Bin) -> str:
    """From 0 to 100 %, the stated probability and the share that is right."""
    cells = ["·"] * (_LINE + 1)
    cells[round(_LINE * min(one.stated, 1.0))] = "│"
    cells[round(_LINE * one.share)] = "●"
    return f"`{''.join(cells)}`"


def _confusion_list(table: dict[str, dict[str, int]]) -> str:
    rows = [
        [
            f"`{hidden}`",
            ", ".join(f"`{named}` {n}" for named, n in sorted(row.items(), key=lambda entry: -entry[1])),
        ]
        for hidden, row in table.items()
    ]
    return _table(["hidden", "named first, how often"], rows)
