# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The workbench's page on a running rig, in a real browser: the error that it shows live falls."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from hasel_bringup.errors import BringupError
from hasel_bringup.experimenter import Experimenter
from hasel_bringup.processes import Processes
from hasel_workbench.browser import Browser, BrowserPage, find_browser

pytest.importorskip("nicegui", reason="NiceGUI is not installed: the extra `page` of hasel_workbench")
pytestmark = pytest.mark.skipif(
    find_browser() is None, reason="no browser is installed: apt install chromium"
)
_PATIENCE_S, _SEARCH_S = 250.0, 900.0
_ERROR, _LIVE_ERROR = (
    f"+document.getElementById('{name}').textContent" for name in ("wb-error", "wb-live-error")
)
_SAID = "document.getElementById('wb-live-said').textContent"
_STOP = "document.querySelector('button.wb-stop')"
_STOP_IS_IN_SIGHT = (
    "((stop, r) => { scrollTo(0, document.body.scrollHeight); return !stop.disabled &&"
    f" stop.contains(document.elementFromPoint(r.x + r.width / 2, r.y + r.height / 2)); }})({_STOP}, {_STOP}"
    ".getBoundingClientRect())"
)
_CAUGHT_UP = (
    "((rows, end) => Math.min(rows.measured.at(-1)[0], rows.simulated.at(-1)[0]) > end - 1 &&"
    " end - Math.max(...rows.voltage.filter(r => r[1] || r[2]).map(r => r[0])) > 2.2)"
    "(live.rows, live.rows.voltage.at(-1)[0])"
)
_STOPPED_ITSELF = f"{_SAID}.startsWith('FAULT')"  # whichever end of a busy machine's line missed the other
_TOO_BUSY = "this machine is too busy for a virtual board: it stopped itself in every run"


def _button(text: str) -> str:
    return f"[...document.querySelectorAll('button')].find(b => b.innerText === '{text}' && b.offsetParent)"


class Desk:
    """Somebody with a virtual rig, a terminal and the page, on which Live is open."""

    def __init__(self, processes: Processes, rig: Experimenter, page: BrowserPage) -> None:
        self.processes, self.rig, self.page = processes, rig, page

    def run(self, voltage: float, frequency: float, periods: int) -> float:
        """Arm, have a run made, and read the running error once the body is at rest."""
        goal = {"voltage": voltage, "frequency": frequency, "periods": periods, "waveform": "box"}
        for _ in range(8):
            self.rig.pause(2.5)  # at rest: another run begins
            self.rig.arm()
            try:
                self.rig.run_experiment(goal, 60.0)
            except BringupError as error:
                assert "experiment" in str(error)
                continue
            self.page.until(f"{_STOPPED_ITSELF} || {_CAUGHT_UP}", _PATIENCE_S)
            if self.page.run(_STOPPED_ITSELF):
                continue
            return self.page.run(_LIVE_ERROR)
        pytest.skip(_TOO_BUSY)

    def take_the_runs(self, least: int) -> None:
        """What was heard is loaded: so many runs at least."""
        self.page.click("Take what was heard as runs", _PATIENCE_S)
        self.page.until(f"window.bench && bench.shown > 0 && bench.runs.length >= {least}", _PATIENCE_S)
        self.idle()

    def make_the_suggested_run(self) -> None:
        """Armed by its own service, the rig makes the run that the page proposes."""
        self.page.click("Suggest the next run", _PATIENCE_S)
        for _ in range(8):
            self.page.until(f"{_button('Start it on the rig')} && !{_button('cancel')}", _SEARCH_S)
            assert self.page.run("document.body.innerText.includes('ros2 action send_goal')")
            self.rig.pause(2.5)
            self.rig.arm()
            self.page.click("Start it on the rig", _PATIENCE_S)
            if self.noted("recordings/", "the run failed", "arm it") == "recordings/":
                self.page.until(_CAUGHT_UP, _PATIENCE_S)
                return
        pytest.skip(_TOO_BUSY)

    def start_simulator(self) -> None:
        """There is none: the page says so and starts one."""
        self.page.until(f"{_SAID}.includes('No simulator is heard')", _PATIENCE_S)
        self.page.click("Start a simulator of this model", _PATIENCE_S)
        self.page.until("live.rows.simulated.length > 0", _PATIENCE_S)
        self.idle()

    def let_it_take_the_model(self) -> None:
        """The running simulator goes on with the model that the page shows."""
        self.page.click("Let the simulator take this model", _PATIENCE_S)
        self.noted("is simulated from now on")
        self.idle()

    def noted(self, *words: str) -> str:
        """Wait until the page has told one of some things, and let it be gone."""
        notes = "[...document.querySelectorAll('.q-notification')].map(e => e.innerText).join()"
        found = f"{list(words)}.find(each => {notes}.includes(each))"
        self.page.until(found, _PATIENCE_S)
        told = self.page.run(found)
        self.page.until(f"!{notes}", _PATIENCE_S)
        return told

    def idle(self) -> None:
        """Nothing is under way."""
        self.page.until(f"!{_button('cancel')}", _PATIENCE_S)

    def stop(self) -> None:
        """STOP is in sight at every width, however far one has scrolled; pressed, the rig is stopped."""
        for width in (1400, 800, 400):
            self.page.resize(width, 900)
            self.page.until(_STOP_IS_IN_SIGHT, 30.0)
            assert self.page.run("document.documentElement.scrollWidth") <= width
        self.page.press_mouse(_STOP)
        self.page.until(f"{_SAID}.startsWith('FAULT') && {_SAID}.includes('mergency stop')", _PATIENCE_S)


@pytest.fixture
def desk(tmp_path, environment, domain, monkeypatch) -> Iterator[Desk]:
    """A rig with drag hidden in its body, and a workbench without any runs."""
    monkeypatch.delenv("PYTEST_CURRENT_TEST")  # NiceGUI behaves otherwise where it sees it
    with Processes(tmp_path, environment) as processes:
        hidden = "hidden:=[quadratic_drag.coefficient=0.25]"
        processes.start("hasel_bringup", "virtual_rig", "--ros-args", "-p", hidden)
        effects = ("--effects", "quadratic_drag,linear_drag", "--output", str(tmp_path / "workbench"))
        processes.start("hasel_workbench", "workbench", "--no-browser", "--port", "0", *effects)
        rig = Experimenter(processes.check, domain)
        try:
            with Browser() as browser:
                page = browser.open(_address(processes, rig))
                yield Desk(processes, rig, _opened(page))
                assert page.errors == []
        finally:
            rig.close()
    assert not _left_over(tmp_path)


def _address(processes: Processes, rig: Experimenter) -> str:
    output = processes.output("workbench")
    found = re.compile(r"http://127\.0\.0\.1:\d+/\?token=\S+")
    rig.until(lambda: found.search(output.read_text()), _PATIENCE_S, "the workbench did not come up")
    return found.search(output.read_text())[0]


def _opened(page: BrowserPage) -> BrowserPage:
    """With Live open, and the rig heard."""
    items = "[...document.querySelectorAll('.q-expansion-item .q-item')]"
    item = f"{items}.find(e => e.innerText.includes('Live: a running rig'))"
    page.until(item, _PATIENCE_S)
    page.until("document.body.matches('.wb-empty')", _PATIENCE_S)
    page.run(f"{item}.click()")
    page.until(f"{_SAID}.includes('grounded')", _PATIENCE_S)
    return page


def _left_over(folder: Path) -> list[str]:
    """Command lines of processes that still use the folder."""
    found = []
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            line = path.read_bytes().replace(b"\0", b" ").decode(errors="replace")
        except OSError:
            continue
        if str(folder) in line:
            found.append(line)
    return found


@pytest.mark.timeout(900)
def test_one_run_is_shown_as_it_comes_and_stopped(desk):
    """Drive, measured against simulated, and the error of the run; STOP is in sight wherever one looks."""
    desk.start_simulator()
    assert desk.run(3000.0, 4.0, 2) > 0.01
    assert desk.page.run("Math.max(...live.rows.voltage.map(r => r[1] || 0))") == pytest.approx(3000.0)
    assert desk.page.run("Math.max(...live.rows.measured.map(r => r[1] || 0))") > 0.02
    desk.stop()


@pytest.mark.slow
@pytest.mark.timeout(3000)
def test_the_live_error_falls(desk, tmp_path):
    """Run, take it, fit, add the effect that a suggested run tells apart: the next run's error has fallen each time."""
    page = desk.page
    desk.start_simulator()
    errors = [desk.run(4500.0, 2.0, 4)]
    desk.take_the_runs(1)
    before = page.run(_ERROR)
    page.click("Fit", _PATIENCE_S)
    page.until(f"{_ERROR} < {0.5 * before}", _PATIENCE_S)
    desk.idle()
    desk.let_it_take_the_model()
    errors.append(desk.run(4500.0, 2.0, 4))

    page.click("Diagnose", _PATIENCE_S)
    page.until("document.querySelector('.chip.missing')", _SEARCH_S)
    desk.idle()
    desk.make_the_suggested_run()
    desk.take_the_runs(3)
    assert not page.run("document.body.innerText.includes('is loaded already')")
    page.click("Diagnose", _PATIENCE_S)
    page.until("document.querySelector('.chip.missing')", _SEARCH_S)
    desk.idle()
    assert page.run("document.querySelector('.wb-effect').dataset.effect") == "quadratic_drag"
    before = page.run(_ERROR)
    page.click("switch on quadratic_drag", _PATIENCE_S)
    page.until(f"{_ERROR} < {0.4 * before}", _PATIENCE_S)
    desk.idle()
    desk.let_it_take_the_model()
    errors.append(desk.run(4500.0, 2.0, 4))
    page.picture(tmp_path / "live.png")
    assert errors[1] < 0.5 * errors[0] and errors[2] < 0.5 * errors[1], errors

    page.click("Keep", _PATIENCE_S)
    page.until(f"!{_button('Keep')}", _PATIENCE_S)
    desk.stop()
