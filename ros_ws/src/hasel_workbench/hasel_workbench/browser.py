# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A browser without a window, by the Chrome DevTools Protocol without a driver program; and how fast the page is."""

import base64
import json
import re
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, ExitStack
from pathlib import Path
from typing import Any

import numpy as np
from hasel_sysid.errors import SysidError

PATIENCE_S = 60.0


class BrowserPage:
    """One page. errors: what its code complained of."""

    def __init__(self, address: str, width: int, height: int, dark: bool) -> None:
        from websockets.sync.client import connect

        self._open = ExitStack()
        self._socket = self._open.enter_context(connect(address, max_size=None, open_timeout=PATIENCE_S))
        self._number, self._session = 0, ""
        self.errors: list[str] = []
        context = self.send("Target.createBrowserContext")["browserContextId"]
        target = self.send("Target.createTarget", url="about:blank", browserContextId=context)["targetId"]
        self._session = self.send("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for part in ("Page", "Runtime", "DOM", "Log"):
            self.send(f"{part}.enable")
        self.send("Emulation.setFocusEmulationEnabled", enabled=True)
        self.send("Emulation.setScrollbarsHidden", hidden=True)
        self.resize(width, height)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.send("Emulation.setEmulatedMedia", features=[scheme])

    def close(self) -> None:
        """Leave it."""
        self._open.close()

    def resize(self, width: int, height: int) -> None:
        """Size of the window in pixels."""
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self.send("Emulation.setDeviceMetricsOverride", **size)

    def go(self, address: str) -> None:
        """Load an address."""
        self.send("Page.navigate", url=address)
        self.until("document.readyState === 'complete'")

    def run(self, code: str) -> Any:
        """Value of an expression, awaited where it is a promise. Raises SysidError where it throws."""
        answer = self.send("Runtime.evaluate", expression=code, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise SysidError(details.get("exception", {}).get("description", details["text"]))
        return answer["result"].get("value")

    def until(self, condition: str, seconds: float = PATIENCE_S) -> None:
        """Wait until an expression is true. Raises SysidError where it does not become so."""
        end = time.monotonic() + seconds
        while True:
            try:
                if self.run(f"!!({condition})"):
                    return
            except SysidError:  # the page is still being built
                if time.monotonic() > end:
                    raise
            if time.monotonic() > end:
                said = self.run("document.body.innerText")
                raise SysidError(f"not within {seconds:g} s: {condition}\n{said}\n{self.errors}")
            time.sleep(0.05)

    def click(self, text: str, seconds: float = PATIENCE_S) -> None:
        """Press the button of this text or label, once it can be pressed."""
        found = (
            "[...document.querySelectorAll('button')].find(each => !each.disabled && each.offsetParent && "
            f"[each.innerText.trim(), each.getAttribute('aria-label')].includes({json.dumps(text)}))"
        )
        self.until(f"!!{found}", seconds)
        self.run(f"{found}.click()")

    def choose_files(self, selector: str, paths: Sequence[Path]) -> None:
        """Give files to an input, as dropping them does."""
        root = self.send("DOM.getDocument")["root"]["nodeId"]
        node = self.send("DOM.querySelector", nodeId=root, selector=selector)["nodeId"]
        self.send("DOM.setFileInputFiles", nodeId=node, files=[str(path) for path in paths])

    def drop_files(self, selector: str, paths: Sequence[Path]) -> None:
        """Drag files from outside onto an element and let go, as from a file manager."""
        self.run(f"document.querySelector({json.dumps(selector)}).scrollIntoView({{block: 'center'}})")
        x, y = self.middle(f"document.querySelector({json.dumps(selector)})")
        data = {"items": [], "files": [str(path) for path in paths], "dragOperationsMask": 1}
        for kind in ("dragEnter", "dragOver", "drop"):
            self.send("Input.dispatchDragEvent", type=kind, x=x, y=y, data=data)

    def press_mouse(self, element: str) -> None:
        """Press the mouse in the middle of what an expression finds, whatever lies there on top."""
        x, y = self.middle(element)
        for kind in ("mousePressed", "mouseReleased"):
            self.send("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def middle(self, element: str) -> tuple[float, float]:
        """Of an element, in pixels of the window."""
        box = f"const r = ({element}).getBoundingClientRect()"
        return tuple(self.run(f"(() => {{ {box}; return [r.x + r.width / 2, r.y + r.height / 2]; }})()"))

    def press(self, key: str) -> None:
        """A key, such as ArrowRight."""
        text = {"text": " "} if key == " " else {}
        for kind in ("keyDown", "keyUp"):
            self.send("Input.dispatchKeyEvent", type=kind, key=key, **(text if kind == "keyDown" else {}))

    def picture(self, path: Path, whole: bool = False) -> Path:
        """The page as a PNG file; whole: with what is below the window too."""
        answer = self.send("Page.captureScreenshot", format="png", captureBeyondViewport=whole)
        path.write_bytes(base64.b64decode(answer["data"]))
        return path

    def addresses(self) -> list[str]:
        """Of everything that it has loaded."""
        return self.run("performance.getEntriesByType('resource').map(each => each.name)")

    def send(self, method: str, **parameters: Any) -> dict[str, Any]:
        """A command of the protocol and its answer. Raises SysidError with what the browser says against it."""
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        self._socket.send(json.dumps(message | ({"sessionId": self._session} if self._session else {})))
        while True:
            answer = json.loads(self._socket.recv(timeout=2 * PATIENCE_S))
            if answer.get("id") == self._number:
                if "error" in answer:
                    raise SysidError(f"{method}: {answer['error'].get('message')}")
                return answer.get("result", {})
            self._heard(answer)

    def _heard(self, event: dict[str, Any]) -> None:
        details = event.get("params", {})
        if event.get("method") == "Runtime.exceptionThrown":
            thrown = details["exceptionDetails"]
            self.errors.append(thrown.get("exception", {}).get("description", thrown["text"]))
        elif event.get("method") == "Log.entryAdded" and details["entry"]["level"] == "error":
            entry = details["entry"]
            self.errors.append(re.sub(r"\s+", " ", entry["text"] + " " + entry.get("url", "")))


_NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")


def find_browser() -> str | None:
    """The program of a browser that speaks the protocol; None where none is installed."""
    return next((path for path in map(shutil.which, _NAMES) if path), None)


class Browser(AbstractContextManager["Browser"]):
    """As a context manager, ends the browser. Raises SysidError where none is installed, or it does not start."""

    def __init__(self, program: str | None = None) -> None:
        program = program or find_browser()
        if program is None:
            raise SysidError(f"no browser was found; expected one of {', '.join(_NAMES)}: install chromium")
        self._folder = tempfile.TemporaryDirectory(prefix="browser-", ignore_cleanup_errors=True)
        options = [
            "--headless=new",
            "--no-sandbox",
            "--disable-gpu",
            "--remote-debugging-port=0",
            "--mute-audio",
        ]
        options += ["--no-first-run", "--disable-extensions", "--disable-background-networking"]
        # several pages at once, none of which is to sleep because another one is in front
        options += ["--disable-renderer-backgrounding", "--disable-background-timer-throttling"]
        options += ["--disable-backgrounding-occluded-windows", "--disable-dev-shm-usage"]
        options += [f"--user-data-dir={self._folder.name}", "about:blank"]
        self._process = subprocess.Popen(
            [program, *options], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
        )
        self._address = self._found_address()
        self.pages: list[BrowserPage] = []

    def open(self, address: str, width: int = 1400, height: int = 900, dark: bool = False) -> BrowserPage:
        """A page of its own at an address, loaded."""
        page = BrowserPage(self._address, width, height, dark)
        self.pages.append(page)
        page.go(address)
        return page

    def close(self) -> None:
        """End it."""
        for page in self.pages:
            page.close()
        self._process.terminate()
        try:
            self._process.wait(10.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._folder.cleanup()

    def __exit__(self, *_: object) -> None:
        self.close()

    def _found_address(self) -> str:
        note, end = Path(self._folder.name) / "DevToolsActivePort", time.monotonic() + PATIENCE_S
        while time.monotonic() < end and self._process.poll() is None:
            lines = note.read_text().split() if note.exists() else []
            if len(lines) == 2:
                return f"ws://127.0.0.1:{lines[0]}{lines[1]}"
            time.sleep(0.05)
        self._process.kill()
        raise SysidError("the browser did not start; try it by hand with --headless --no-sandbox")


_DRAGS, _LOADED_S = 12, 300.0
_DRAG = (
    "(() => {{ const s = [...document.querySelectorAll('input[data-name]')].pop(); s.value = +s.value + {};"
    " s.dispatchEvent(new Event('input', {{bubbles: true}})); }})()"
)
_WEIGHT = "performance.getEntriesByType('resource').reduce((sum, each) => sum + each.transferSize, 0)"


def measure(address: str, tell: Callable[[str], None]) -> None:
    """Drive a page of a workbench with runs in a browser without a window, and tell what was measured beside its bar.

    Raises SysidError where no browser is installed.
    """
    with Browser() as browser:
        page = browser.open(address)
        page.until("window.bench && bench.shown > 0", _LOADED_S)
        runs, weight = page.run("bench.runs"), page.run(_WEIGHT)
        here = (address.partition("?")[0], "data:")
        local = "yes" if all(each.startswith(here) for each in page.addresses()) else "NO"
        tell(f"runs: {len(runs)}; the page loads {weight / 1e6:.1f} MB, all from here: {local}")
        foretold, true = _drags(page)
        tell(f"a value dragged, new curve foretold and drawn: {_times(foretold)} (bar 100 ms)")
        tell(f"… true simulation of the run drawn: {_times(true)} (bar 1000 ms)")
        page.run("bench.play()")
        rates = []
        for _ in range(5):  # the first one counts from before the motion began
            page.run("bench.rate = 0")
            page.until("bench.rate > 0", _LOADED_S)
            rates.append(page.run("bench.rate"))
        tell(f"motion: {np.median(rates[1:]):.0f} frames/s (bar 30)")


def _drags(page: BrowserPage) -> tuple[list[float], list[float]]:
    """Times [ms] from the input to the picture, foretold and true."""
    for number in range(_DRAGS):
        page.run("bench.times = {predict: [], truth: [], ...window.wbKept}")
        page.run(_DRAG.format(40 if number % 2 else -40))
        drawn = f"bench.times.predict.length > {number} && bench.times.truth.length > {number}"
        page.until(drawn, _LOADED_S)
        page.run("window.wbKept = bench.times")
    return page.run("bench.times.predict"), page.run("bench.times.truth")


def _times(found: list[float]) -> str:
    return f"median {np.median(found):.0f} ms, largest {max(found):.0f} ms of {len(found)}"
