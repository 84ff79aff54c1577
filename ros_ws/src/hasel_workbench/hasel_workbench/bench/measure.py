"""How fast the page answers: a dragged value, the motion, and what it weighs."""

from collections.abc import Callable

import numpy as np

from hasel_workbench.bench.browser import Browser
from hasel_workbench.bench.browser_page import BrowserPage

_DRAGS, _PATIENCE_S = 12, 300.0
_DRAG = (
    "(() => {{ const s = [...document.querySelectorAll('input[data-name]')].pop(); s.value = +s.value + {};"
    " s.dispatchEvent(new Event('input', {{bubbles: true}})); }})()"
)


def measure(address: str, tell: Callable[[str], None]) -> None:
    """Drive a page of a workbench with runs in a browser without a window, and tell what was measured beside its bar.

    Raises SysidError where no browser is installed.
    """
    with Browser() as browser:
        page = browser.open(address)
        page.until("window.bench && bench.shown > 0", _PATIENCE_S)
        runs = page.run("bench.runs")
        weight = page.run(
            "performance.getEntriesByType('resource').reduce((sum, each) => sum + each.transferSize, 0)"
        )
        tell(
            f"runs: {len(runs)}; the page loads {weight / 1e6:.1f} MB, all from here: {_local(page, address)}"
        )
        foretold, true = _drags(page)
        tell(f"a value dragged, new curve foretold and drawn: {_times(foretold)} (bar 100 ms)")
        tell(f"… true simulation of the run drawn: {_times(true)} (bar 1000 ms)")
        page.run("bench.play()")
        page.until("bench.rate > 0", _PATIENCE_S)
        rates = []
        for _ in range(4):
            page.run("bench.rate = 0")
            page.until("bench.rate > 0", _PATIENCE_S)
            rates.append(page.run("bench.rate"))
        tell(f"motion: {np.median(rates):.0f} frames/s (bar 30)")


def _drags(page: BrowserPage) -> tuple[list[float], list[float]]:
    """Times [ms] from the input to the picture, foretold and true."""
    for number in range(_DRAGS):
        page.run("bench.times = {predict: [], truth: [], ...window.wbKept}")
        page.run(_DRAG.format(40 if number % 2 else -40))
        page.until(
            f"bench.times.predict.length > {number} && bench.times.truth.length > {number}", _PATIENCE_S
        )
        page.run("window.wbKept = bench.times")
    return page.run("bench.times.predict"), page.run("bench.times.truth")


def _times(found: list[float]) -> str:
    return f"median {np.median(found):.0f} ms, largest {max(found):.0f} ms of {len(found)}"


def _local(page: BrowserPage, address: str) -> str:
    return (
        "yes"
        if all(each.startswith((address.partition("?")[0], "data:")) for each in page.addresses())
        else "NO"
    )
