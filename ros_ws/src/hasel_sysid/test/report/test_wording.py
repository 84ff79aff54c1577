# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Numbers as a reader wants them."""

import numpy as np
import pytest
from hasel_sim.model import load_model
from hasel_sysid.answer.diagnosis import Finding, Verdict
from hasel_sysid.report.from_improvement import ranked_rows
from hasel_sysid.report.from_results import parameter_rows
from hasel_sysid.report.wording import (
    change_text,
    count_text,
    error_text,
    interval_text,
    percent,
)


@pytest.mark.parametrize(
    ("value", "error", "unit", "text"),
    [
        (0.0694496, 0.0056, "s", "0.0694 s (95 % interval 0.0585 to 0.0804)"),
        (0.248, 0.003, "1", "0.2480 (95 % interval 0.2421 to 0.2539)"),
        (1200.0, 150.0, "Pa", "1200 Pa (95 % interval 906 to 1494)"),
        (0.5, None, "1/s", "0.5 1/s"),
    ],
)
def test_interval(value, error, unit, text):
    """A value with unit and 95 % interval, to two digits of the standard error."""
    assert interval_text(value, error, unit) == text


def test_percent():
    """Shares in per cent, unknown ones as a dash."""
    assert [percent(share) for share in (0.93, 0.0996, 0.004, 1e-9, 0.0, float("nan"))] == [
        "93 %",
        "10 %",
        "0.4 %",
        "< 0.1 %",
        "0 %",
        "–",
    ]


def test_errors_small_and_large():
    """Errors have four decimals unless these would be zeros; changes have a sign, counts their noun."""
    assert [error_text(error) for error in (0.0259, 0.0, 1.6e-5)] == ["0.0259", "0.0000", "1.6e-05"]
    assert [change_text(change) for change in (-0.0938, 0.002)] == ["−0.0938", "+0.0020"]
    assert [count_text(count, "run") for count in (1, 3)] == ["1 run", "3 runs"]


def test_every_parameter_has_a_meaning_and_effects_have_their_range_with_its_source():
    """An amplitude in words; the charge time beside the range that its source gives."""
    model = load_model("swimmer").with_levels(np.array([4500.0])).with_effects("charging_lag")
    rows = {row.name: row for row in parameter_rows(model)}
    assert rows["amplitude_4500"].meaning == "share by which a muscle shortens at 4500 of its drive"
    assert all(row.meaning for row in rows.values())
    assert rows["charging_lag.charge_time"].plausible.startswith("0 to 0.5 (")
    assert rows["slope"].plausible == "0.02 to 50"


def test_an_effect_of_the_users_own_brings_its_physics(tmp_path):
    """From its file; an absent effect has no estimate, since that is of a model without the one that is missing."""
    path = tmp_path / "mine.py"
    path.write_text(
        "from hasel_sim.effects.base import DriveEffect, EffectParameter\n\n\n"
        "class Mine(DriveEffect):\n"
        '    physics, equation = "Less voltage arrives.", "V <- (1 - k) V"\n'
        '    parameters = (EffectParameter("k", "k", "1", 0.0, 0.0, 0.5, 0.1),)\n\n'
        "    def respond(self, time, signal, p):\n"
        "        return (1 - p.k) * signal\n"
    )

    class Found:
        findings = (
            Finding(
                "Mine",
                Verdict.MISSING,
                0.9,
                0.9,
                {"Mine.k": (0.2, 0.01)},
                {"Mine.k": "1"},
                0.1,
                0.01,
                source=f"{path}:Mine",
            ),
            Finding(
                "tether",
                Verdict.ABSENT,
                0.0,
                0.9,
                {"tether.stiffness": (9.0, 1.0)},
                {"tether.stiffness": "N/m^2"},
                0.1,
                0.01,
            ),
        )

    own, absent = ranked_rows(Found)
    assert own.physics == "Less voltage arrives."
    assert own.expected[0].plausible == "0 to 0.5"
    assert absent.expected == ()
    assert absent.error_removed != absent.error_removed


def test_a_value_beyond_what_its_source_gives_is_remarked_on():
    """Below what is usual, beyond what is plausible; nothing of one that does nothing."""
    model = load_model("swimmer").with_effects("quadratic_drag")
    for value, said in (
        (0.248, "below the 1 to 8 that are usual"),
        (12.0, "above the 0 to 10 that are plausible"),
        (3.0, ""),
        (0.0, ""),
    ):
        changed = model.with_values({"quadratic_drag.coefficient": value})
        (row,) = [r for r in parameter_rows(changed) if r.name == "quadratic_drag.coefficient"]
        assert row.remark == said
