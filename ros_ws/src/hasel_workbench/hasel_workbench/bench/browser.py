"""A browser without a window, driven by the Chrome DevTools Protocol: no driver program is needed."""

import shutil
import subprocess
import tempfile
import time
from pathlib import Path

from hasel_sysid.errors import SysidError

from hasel_workbench.bench.browser_page import PATIENCE_S, BrowserPage

_NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")


def find_browser() -> str | None:
    """The program of a browser that speaks the protocol; None where none is installed."""
    return next((path for path in map(shutil.which, _NAMES) if path), None)


class Browser:
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
        options += ["--disable-backgrounding-occluded-windows"]
        options += ["--disable-dev-shm-usage", f"--user-data-dir={self._folder.name}", "about:blank"]
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

    def __enter__(self) -> "Browser":
        return self

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
