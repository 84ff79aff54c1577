# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The report on paper, printed by a real browser."""

import base64
import re

import numpy as np
import pytest
from hasel_sysid.report.content import ParameterRow, RankedRow, ReportContent, RunOverlay, StageRow
from hasel_sysid.report.write import write_report
from hasel_workbench.browser import Browser, find_browser

pytestmark = pytest.mark.skipif(
    find_browser() is None, reason="no browser is installed: apt install chromium"
)
MOST_PAGES = 6


def report() -> ReportContent:
    """As long as a usual one: twelve runs, thirty effects of which most are absent, as many models."""
    time = np.linspace(0, 2, 240)
    swing = 0.2 * np.sin(12 * time)
    runs = [RunOverlay(f"run_{n}", time, swing, {"fitted": 0.8 * swing, "+ drag": swing}) for n in range(12)]
    sentence = (
        "is absent: above 0.013 it would have been seen beside quadratic_drag; alone it would imitate 63 %."
    )
    absent = [
        RankedRow(f"effect_{n}", "absent", 0.0, np.nan, (), 0.3, "What it is. " * 8, sentence)
        for n in range(30)
    ]
    size = ParameterRow(
        "coefficient", 0.25, 0.004, "1", "below the 1 to 8 that are usual", plausible="0 to 10"
    )
    found = RankedRow("quadratic_drag", "missing", 0.99, 0.99, [size], 0.4, "What it is.", "It is missing.")
    rows = [ParameterRow(f"parameter_{n}", 0.1, 0.01, "1", meaning="what it means") for n in range(12)]
    stages = (
        StageRow("start", 0.08, 0.09),
        StageRow("fit", 0.03, 0.05),
        StageRow("+ quadratic_drag", 0.003, 0.004),
    )
    return ReportContent(
        title="Missing: quadratic_drag",
        verdict="What is left is noise.",
        runs=runs,
        ranking=[found, *absent],
        parameters=rows,
        stages=stages,
        noise_floor=0.002,
        remains=["Two per cent are left."] * 5,
    )


def test_it_is_six_pages_at_most(tmp_path):
    """Absent effects stay folded, four runs stand beside each other; on the screen all is as before."""
    path = write_report(report(), tmp_path)
    with Browser() as browser:
        page = browser.open(path.as_uri())
        page.until("document.documentElement.dataset.drawn === 'yes'")
        width = page.run("document.querySelector('.runs .figure').offsetWidth")
        printed = base64.b64decode(page.send("Page.printToPDF", preferCSSPageSize=True)["data"])
        assert page.run("document.querySelector('.runs .figure').offsetWidth") == width
        folded = page.run("document.querySelector('details.folded').innerText")
    assert "30 effects" in folded
    assert 1 < len(re.findall(rb"/Type\s*/Page[^s]", printed)) <= MOST_PAGES


def test_the_button_for_a_picture_stays_on_the_screen(tmp_path):
    """Paper has no buttons."""
    path = write_report(report(), tmp_path)
    with Browser() as browser:
        page = browser.open(path.as_uri())
        page.until("document.documentElement.dataset.drawn")
        shown = "getComputedStyle(document.querySelector('.modebar-container')).display"
        assert page.run(shown) != "none"
        page.send("Emulation.setEmulatedMedia", media="print")
        assert page.run(shown) == "none"
