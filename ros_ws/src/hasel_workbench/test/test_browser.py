# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The page in a real browser: load, see, try, watch the error fall, take it back."""

import http.client
import os
import re
import select
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from hasel_workbench.browser import Browser, BrowserPage, find_browser
from hasel_workbench.page.access import RedirectFile

pytest.importorskip("nicegui", reason="NiceGUI is not installed: the extra `page` of hasel_workbench")
pytestmark = [
    pytest.mark.skipif(find_browser() is None, reason="no browser is installed: apt install chromium"),
    pytest.mark.timeout(500),
]
_PATIENCE_S = 200.0
_START = "from hasel_workbench.command import main; import sys; sys.exit(main(sys.argv[1:]))"
_ERROR = "+document.getElementById('wb-error').textContent"


class Server:
    """The command as a process of its own."""

    def __init__(self, folder: Path, *arguments: object) -> None:
        command = [sys.executable, "-c", _START, *map(str, arguments), "--output", str(folder), "--port", "0"]
        command += ["--no-browser", "--no-rig", "--effects", "quadratic_drag,linear_drag"]
        own = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
        self._process = subprocess.Popen(  # NiceGUI behaves otherwise where it sees pytest
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=own
        )
        self.address = self._address()

    def _address(self) -> str:
        ready, _, _ = select.select([self._process.stdout], [], [], _PATIENCE_S)
        line = self._process.stdout.readline() if ready else ""
        found = re.search(r"http://127\.0\.0\.1:\d+/\?token=\S+", line)
        if not found:
            self._process.kill()
            raise AssertionError(f"{line!r} {self._process.communicate()[1]}")
        return found[0]

    def close(self) -> str:
        self._process.terminate()
        try:
            return self._process.communicate(timeout=30)[1]
        except subprocess.TimeoutExpired:
            self._process.kill()
            return self._process.communicate()[1]


@pytest.fixture(scope="module")
def server(tmp_path_factory, unseen_rig) -> Iterator[Server]:
    """A workbench with two runs to fit and one unseen."""
    rig_folder = unseen_rig / "quadratic_drag"
    fitted = [rig_folder / "fit_4500V_3.5Hz.csv", rig_folder / "fit_5500V_2.0Hz.csv"]
    one = Server(tmp_path_factory.mktemp("served"), *fitted, "--validate", rig_folder / "val_5200V_2.5Hz.csv")
    yield one
    one.close()


@pytest.fixture
def server_without_runs(tmp_path) -> Iterator[Server]:
    """A workbench that nothing was given to."""
    one = Server(tmp_path / "empty")
    yield one
    one.close()


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """One for all tests."""
    with Browser() as one:
        yield one


@pytest.fixture(scope="module")
def page(server, browser) -> BrowserPage:
    """A page on which the runs are drawn."""
    one = browser.open(server.address)
    one.until("window.bench && bench.shown > 0", _PATIENCE_S)
    return one


def idle(page: BrowserPage) -> None:
    """Wait until nothing is under way and the page shows it."""
    page.until(
        "![...document.querySelectorAll('button')].some(b => b.innerText === 'cancel' && b.offsetParent)",
        _PATIENCE_S,
    )


def test_the_body_moves_and_the_map_leads_to_its_stretch(page):
    """Played, time goes on and the picture changes; a clicked cell zooms the curve and stops the body there."""
    picture = "document.getElementById('wb-body').toDataURL()"
    page.run("bench.select('fit_5500V_2.0Hz')")
    page.run("bench.seek(0)")
    before = page.run(picture)
    page.run("bench.toggle()")
    page.until("bench.time > 0.2", _PATIENCE_S)
    assert page.run(picture) != before
    page.run('document.querySelector(\'td[data-run="val_5200V_2.5Hz"][data-cell="5"]\').click()')
    page.until("bench.curve.mark && bench.run === 'val_5200V_2.5Hz'", _PATIENCE_S)
    assert page.run("!bench.playing && bench.time > bench.curve.mark[0] && bench.time < bench.curve.mark[1]")
    page.run("document.querySelector('td[data-cell=\"5\"]').focus()")
    page.press("ArrowRight")
    assert page.run("document.activeElement.dataset.cell") == "6"
    page.run("document.activeElement.blur()")
    at = page.run("bench.time")
    page.press("ArrowRight")
    assert page.run("bench.time") > at
    page.run("bench.whole()")


def test_played_slowly_in_other_colours_run_by_run(page):
    """A tenth of the speed passes a tenth of the time; contraction is coloured otherwise; n and p change the run."""
    choose = (
        "(() => {{ const s = document.getElementById('{}'); s.value = '{}';"
        " s.dispatchEvent(new Event('change', {{bubbles: true}})); }})()"
    )
    page.run("bench.select('fit_5500V_2.0Hz')")
    page.run("bench.seek(0.4)")
    picture = page.run("document.getElementById('wb-body').toDataURL()")
    page.run(choose.format("wb-colour", "contraction"))
    assert page.run("document.getElementById('wb-body').toDataURL()") != picture
    page.run(choose.format("wb-speed", "0.1"))
    page.run("bench.seek(0)")
    page.run("window.wbBegan = performance.now(); bench.play()")
    page.until("bench.time > 0.05", _PATIENCE_S)
    passed = page.run("bench.pause(), (performance.now() - window.wbBegan) / 1000 / bench.time")
    assert passed > 8.0
    for name in ("wb-colour", "wb-speed"):
        page.run(choose.format(name, {"wb-colour": "strain", "wb-speed": "1"}[name]))
    for key, run in (("p", "fit_4500V_3.5Hz"), ("n", "fit_5500V_2.0Hz")):
        page.press(key)
        page.until(f"bench.run === '{run}' && document.querySelector('tr.chosen').dataset.row === '{run}'")


def test_nothing_comes_from_elsewhere(page, server):
    """All that the page loads comes from this machine."""
    assert all(
        address.startswith((server.address.partition("?")[0], "data:")) for address in page.addresses()
    )
    assert page.errors == []


def test_only_this_machine_is_answered(server):
    """It listens at the loopback address alone, and not to a page elsewhere that gives its own name this address."""
    port = urlsplit(server.address).port
    rows = [line.split() for line in Path("/proc/net/tcp").read_text().splitlines()[1:]]
    listening = [row[1].split(":") for row in rows if row[3] == "0A"]
    assert [host for host, at in listening if int(at, 16) == port] == ["0100007F"]
    for host, status in (("localhost", 303), ("elsewhere.example", 400)):
        with closing(http.client.HTTPConnection("127.0.0.1", port, timeout=_PATIENCE_S)) as connection:
            connection.request("GET", f"/?{urlsplit(server.address).query}", headers={"Host": host})
            assert connection.getresponse().status == status


def test_the_file_given_to_a_browser_leads_to_the_page(server_without_runs, browser, tmp_path):
    """Where no cookie was kept yet."""
    file = RedirectFile(server_without_runs.address, tmp_path)
    browser.open(file.uri).until("document.querySelector('.wb-head')", _PATIENCE_S)


def test_everything_has_a_name(page):
    """Buttons, inputs and pictures say to a screen reader what they are."""
    nameless = page.run(
        "[...document.querySelectorAll('button, input:not([type=file]), canvas, svg.waterfall')]"
        ".filter(e => e.offsetParent && !(e.getAttribute('aria-label') || e.innerText || "
        "e.closest('label') || e.closest('[aria-label]'))).map(e => e.outerHTML)"
    )
    assert nameless == []


def test_a_truncated_file_is_a_banner(page, tmp_path):
    """With the file's name and what is wrong; the session goes on."""
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(b"\x89MCAP0\r\n\x00\x01")
    page.choose_files(".wb-upload-fitted input[type=file]", [cut])
    page.until(
        "[...document.querySelectorAll('.wb-banner.error')].some(e => e.innerText.includes('cut'))",
        _PATIENCE_S,
    )
    idle(page)
    page.click("I have read these")
    page.until("!document.querySelector('.wb-banner')", _PATIENCE_S)
    assert page.run("bench.runs.length") == 3


def test_a_dropped_file_is_loaded(server_without_runs, browser, unseen_rig, tmp_path):
    """Dragged onto where runs to fit, and where unseen ones, are dropped, or anywhere on the page; two at once, too."""
    one = browser.open(server_without_runs.address)
    one.until(
        "document.querySelector('.wb-upload-fitted') && document.body.matches('.wb-empty')", _PATIENCE_S
    )
    rig = unseen_rig / "quadratic_drag"
    fitted = [rig / "fit_4500V_3.5Hz.csv", rig / "fit_5500V_3.5Hz.csv"]
    one.drop_files(".wb-upload-fitted", fitted)
    one.until("window.bench && bench.shown > 0", _PATIENCE_S)
    assert one.run("bench.runs") == [path.stem for path in fitted]
    idle(one)
    one.drop_files(".wb-upload-unseen", [rig / "val_5200V_2.5Hz.csv"])
    one.until("document.getElementById('wb-error-unseen')", _PATIENCE_S)
    one.until("bench.runs.length === 3", _PATIENCE_S)
    idle(one)
    one.drop_files("#wb-curve", [rig / "fit_3500V_3.5Hz.csv"])
    one.until("bench.runs.includes('fit_3500V_3.5Hz')", _PATIENCE_S)
    assert one.run("document.querySelectorAll('tr[data-row] .chip').length") == 1
    assert one.errors == []


def test_the_four_steps(page, server, browser, tmp_path):
    """The top effect is the hidden one; on, the error falls; another page sees it; taken back, all is as before."""
    page.run("bench.select('val_5200V_2.5Hz')")
    page.click("Diagnose")
    page.until("document.querySelector('.chip.missing')", _PATIENCE_S)
    idle(page)
    assert page.run("document.querySelector('.wb-effect').dataset.effect") == "quadratic_drag"
    card = page.run("document.querySelector('.wb-effect details').textContent")
    for word in ("equation", "parameter coefficient", "plausible", "signature", "separated by", "source"):
        assert word in card
    bars = "[...document.querySelectorAll('svg.waterfall')].map(e => e.querySelectorAll('rect').length)"
    assert page.run(bars) == [3, 3]
    before = page.run(_ERROR)
    page.click("switch on quadratic_drag")
    page.until(f"{_ERROR} < {0.4 * before}", _PATIENCE_S)
    tried = page.run(_ERROR)
    page.until("bench.curve.data.rows.includes('before')", _PATIENCE_S)
    page.picture(tmp_path / "tried.png")
    assert page.run(bars) == [4, 4]  # on fitted and on unseen runs

    other = browser.open(server.address, 800, 900, dark=True)
    other.until(f"window.bench && bench.shown > 0 && {_ERROR} === {tried}", _PATIENCE_S)
    assert other.run("document.documentElement.scrollWidth <= 800")
    assert other.run("document.body.classList.contains('body--dark')")
    other.click("Keep")
    page.until("[...document.querySelectorAll('ol.steps li')].length === 3", _PATIENCE_S)
    page.go(server.address)  # reload: the session is the server's
    page.until(f"window.bench && bench.shown > 0 && {_ERROR} === {tried}", _PATIENCE_S)
    assert page.run("bench.run") == "val_5200V_2.5Hz"  # what the page itself had chosen, too
    page.click("Take back")
    page.until(f"{_ERROR} === {before}", _PATIENCE_S)
    other.until(f"{_ERROR} === {before}", _PATIENCE_S)
    assert page.errors == other.errors == []


@pytest.mark.parametrize("width", [400, 700, 1400])
def test_the_layout_holds(page, width, tmp_path):
    """Nothing is wider than the page, no card lies over another, also where runs are being loaded."""
    page.resize(width, 900)
    page.run("[...document.querySelectorAll('.q-expansion-item .q-item')][0].click()")
    page.until(
        "[...document.querySelectorAll('.q-uploader')].every(u => u.getBoundingClientRect().height > 40) &&"
        " !document.querySelector('.q-expansion-item__content').style.height",
        _PATIENCE_S,
    )
    over = (
        "(() => { const cards = [...document.querySelectorAll('.wb-card')].filter(c => c.offsetParent)"
        ".map(c => c.getBoundingClientRect()); return cards.flatMap((a, i) => cards.slice(i + 1).filter(b =>"
        " a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1)).length; })()"
    )
    inside = (
        "[...document.querySelectorAll('.wb-card *')].filter(e => e.offsetParent && e.offsetWidth &&"
        " e.getBoundingClientRect().right > e.closest('.wb-card').getBoundingClientRect().right + 1).length"
    )
    page.picture(tmp_path / f"{width}.png", True)
    try:
        assert page.run("document.documentElement.scrollWidth") <= width
        assert page.run(over) == 0
        assert page.run(inside) == 0
        if width == 400:  # the slider and the curve that it moves are seen together
            top = "document.querySelector('{}').getBoundingClientRect().top"
            away = page.run(f"{top.format('input[data-name]')} - {top.format('#wb-curve')}")
            assert 0 < away < 700
            page.run("window.scrollTo(0, document.documentElement.scrollHeight)")
            page.run("window.ends = e => e.getBoundingClientRect().bottom")
            bottom = "Math.max(...[...document.querySelectorAll('.wb-card')].map(ends))"
            stop = "document.querySelector('.wb-stop').getBoundingClientRect().top"
            assert page.run(f"{bottom} <= {stop}")  # nothing is left below the button
            told = "Math.max(...[...document.querySelectorAll('.q-notifications__list--bottom')].map(ends))"
            assert 0 < page.run(told) <= page.run(stop)
    finally:
        page.run("[...document.querySelectorAll('.q-expansion-item .q-item')][0].click()")
        page.resize(1400, 900)


@pytest.fixture
def fresh_page(tmp_path, unseen_rig, browser) -> Iterator[BrowserPage]:
    """A page of its own workbench, with a model that nobody fitted yet."""
    one = Server(tmp_path / "fresh", unseen_rig / "quadratic_drag" / "fit_5500V_2.0Hz.csv")
    page = browser.open(one.address)
    page.until("window.bench && bench.shown > 0", _PATIENCE_S)
    yield page
    one.close()


def test_a_small_value_is_set_by_mouse_key_and_number(fresh_page, tmp_path):
    """Beside the null a pixel and a key step are a small part of the typical size; a number is taken as it is."""
    page = fresh_page
    idle(page)
    page.click("switch on quadratic_drag")
    slider = "document.querySelector('input[data-name=\"quadratic_drag.coefficient\"]')"
    page.until(slider, _PATIENCE_S)
    idle(page)
    values = page.run(
        f"(() => {{ const s = {slider}, n = s.clientWidth, found = [];"
        " for (let i = 0; i <= n; i++) { s.value = 1000 * i / n; found.push(tuning.value(s)); } return found; })()"
    )
    assert (values[0], values[-1]) == (0.0, 10.0)
    assert min(abs(value - 0.25) for value in values) < 0.005
    page.picture(tmp_path / "tuned.png", True)
    field = "document.querySelector('input[data-exact=\"quadratic_drag.coefficient\"]')"
    page.run(f"{slider}.value = 0, {slider}.focus()")
    page.press("ArrowRight")
    assert page.run(f"+{field}.value") == pytest.approx(0.03, abs=0.005)  # of 0.3, which is typical
    page.until(f"{slider}.dataset.value < 0.1", _PATIENCE_S)
    idle(page)
    page.until(f"document.activeElement === {slider}", _PATIENCE_S)
    page.press("ArrowRight")
    assert page.run(f"+{field}.value") == pytest.approx(0.06, abs=0.005)
    page.until(f"{slider}.dataset.value > 0.05 && {slider}.dataset.value < 0.1", _PATIENCE_S)
    idle(page)
    page.run(f"{field}.value = 0.2537, {field}.dispatchEvent(new Event('change', {{bubbles: true}}))")
    page.until(f"{slider}.dataset.value === '0.2537'", _PATIENCE_S)
    idle(page)
    page.click("Take back")
    page.until(f"!{slider}", _PATIENCE_S)
    assert page.errors == []


def test_a_value_dragged_far_is_said_to_be_beyond_first_order(fresh_page):
    """The true curve of the run comes, and the foretold errors are struck through until the value is let go."""
    page = fresh_page
    idle(page)
    before = page.run(_ERROR)
    drag = (
        "(() => {{ const s = document.querySelector('input[data-name=slope]'); s.value = {};"
        " s.dispatchEvent(new Event('{}', {{bubbles: true}})); }})()"
    )
    assert page.run("document.getElementById('wb-beyond').hidden")
    page.run(drag.format(0, "input"))
    page.until("!document.getElementById('wb-beyond').hidden && bench.curve.foretold.true", _PATIENCE_S)
    assert page.run("document.getElementById('wb-error').dataset.how") == "beyond"
    page.run(drag.format(0, "change"))
    page.until(
        f"document.getElementById('wb-beyond').hidden && !document.getElementById('wb-error').dataset.how &&"
        f" {_ERROR} !== {before}",
        _PATIENCE_S,
    )
    idle(page)
    page.click("Take back")
    page.until(f"{_ERROR} === {before}", _PATIENCE_S)


def test_what_is_under_way_disables_the_buttons(page):
    """Nothing can be begun twice."""
    idle(page)
    page.click("Diagnose")
    fit = "[...document.querySelectorAll('button')].find(b => b.innerText === 'Fit').disabled"
    page.until(fit, _PATIENCE_S)
    page.click("cancel")
    page.until(f"!{fit}", _PATIENCE_S)


def test_a_run_is_made_unseen_and_fitted_again(page):
    """By the buttons of its row."""
    idle(page)
    act = "document.querySelector('tr[data-row=\"fit_4500V_3.5Hz\"] button[data-act={}]')"
    page.run(f"{act.format('unseen')}.click()")
    page.until(act.format("fit"), _PATIENCE_S)
    idle(page)
    page.run(f"{act.format('fit')}.click()")
    page.until(act.format("unseen"), _PATIENCE_S)
    idle(page)


def test_columns_are_named_in_the_page(page, tmp_path, unseen_rig):
    """A file of other names is read once its columns are chosen."""
    idle(page)
    path = tmp_path / "lab.csv"
    text = (unseen_rig / "quadratic_drag" / "fit_4500V_3.5Hz.csv").read_text()
    path.write_text(text.replace("sin_theta", "bend"))
    page.run("window.scrollTo(0, document.documentElement.scrollHeight)")
    page.choose_files(".wb-upload-unseen input[type=file]", [path])
    page.until("document.body.innerText.includes('Which column is which in lab.csv?')", _PATIENCE_S)
    page.until("document.activeElement.matches('[data-question]')", _PATIENCE_S)
    seen = "document.activeElement.getBoundingClientRect()"
    page.until(f"{seen}.top >= 0 && {seen}.bottom <= innerHeight")
    idle(page)
    page.click("Read it so")  # without an angle
    page.until("document.querySelector('[data-question] .wb-banner')", _PATIENCE_S)
    assert page.run("document.querySelectorAll('.wb-banner').length") == 1
    angle = "[...document.querySelectorAll('.wb-column-of')].find(e => e.innerText.includes('angle'))"
    page.run(f"{angle}.querySelector('.q-field__native').click()")
    option = "[...document.querySelectorAll('.q-menu .q-item')].find(e => e.innerText === 'bend')"
    page.until(option, _PATIENCE_S)
    page.run(f"{option}.click()")
    page.until(f"{angle}.innerText.includes('bend')", _PATIENCE_S)
    page.click("Read it so")
    row = "document.querySelector('tr[data-row=\"lab\"]')"
    page.until(f"{row} && !document.body.innerText.includes('Which column is which')", _PATIENCE_S)
    idle(page)
    page.run(f"{row}.querySelector('button[data-act=remove]').click()")
    page.until(f"!{row}", _PATIENCE_S)
    idle(page)


def test_a_dragged_value_is_followed(page):
    """At once by the derivatives, then by the true simulation; let go, the session has it, and gives it back."""
    idle(page)
    before = page.run(_ERROR)
    page.run("bench.times = {predict: [], truth: []}")
    drag = (
        "(() => {{ const s = document.querySelector('input[data-name=slope]'); s.value = +s.value - 60;"
        " s.dispatchEvent(new Event('{}', {{bubbles: true}})); }})()"
    )
    page.run(drag.format("input"))
    page.until("bench.times.predict.length && bench.times.truth.length", _PATIENCE_S)
    foretold, true = page.run("bench.times.predict[0]"), page.run("bench.times.truth[0]")
    assert foretold < 5_000 and true < 30_000  # the bars, 100 ms and 1 s, are measured by --bench
    page.run(drag.format("input"))
    page.run(drag.format("change"))
    page.until(
        f"document.getElementById('wb-error').dataset.how !== 'foretold' && {_ERROR} !== {before}",
        _PATIENCE_S,
    )
    idle(page)
    page.click("Take back")
    page.until(f"{_ERROR} === {before}", _PATIENCE_S)


def test_work_can_be_cancelled(page):
    """Its progress is shown and the page is not held up; cancelled, nothing has changed, the next work can begin."""
    idle(page)
    before, shown = page.run(_ERROR), page.run("bench.shown")
    page.click("Diagnose")
    page.run("bench.select('fit_4500V_3.5Hz')")
    assert page.run("bench.shown") > shown
    page.click("cancel")
    page.until("document.body.innerText.includes('cancelled, nothing was changed')", _PATIENCE_S)
    assert page.run(_ERROR) == before
    idle(page)


def test_export_gives_links(page, server, browser):
    """To the report, the script and the model, which this machine serves."""
    page.click("Export")
    page.until("document.querySelector('a[href*=\"report.html\"]')", _PATIENCE_S)
    shown = page.run("[...document.querySelectorAll('ul.wb-files a')].map(a => a.innerText)")
    assert shown[:3] == ["report.html", "session.py", "model.yaml"]
    assert {"waterfall.svg", "fit_5500V_2.0Hz.svg", "error_by_step.png"} <= set(shown)
    assert page.run("fetch('/export/session.py').then(a => a.text())").startswith(
        '"""What was done in the workbench'
    )
    report = browser.open(server.address.replace("?", "export/report.html?"), 390, 800)
    report.until("document.querySelector('.js-plotly-plot, .main-svg')", _PATIENCE_S)
    assert report.run("document.documentElement.scrollWidth") <= 390  # a phone's
    assert report.errors == []


def test_it_ends_without_a_trace(tmp_path):
    """An interrupted server ends at once, quietly, with its processes and what they share."""
    one = Server(tmp_path / "out")
    began = time.monotonic()
    assert one.close() == ""
    assert time.monotonic() - began < 30
    assert not (tmp_path / "out" / "workbench.jsonl").exists()
