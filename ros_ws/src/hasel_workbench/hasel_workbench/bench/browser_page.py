"""One page of a browser that is driven by the Chrome DevTools Protocol: what a user does to it, and what it shows."""

import base64
import json
import re
import time
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

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
        self.send(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=False,
        )

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
        return tuple(
            self.run(
                f"(() => {{ const r = ({element}).getBoundingClientRect(); "
                "return [r.x + r.width / 2, r.y + r.height / 2]; })()"
            )
        )

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

    def send(self, method: str, **parameters: Any) -> dict:
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

    def _heard(self, event: dict) -> None:
        details = event.get("params", {})
        if event.get("method") == "Runtime.exceptionThrown":
            thrown = details["exceptionDetails"]
            self.errors.append(thrown.get("exception", {}).get("description", thrown["text"]))
        elif event.get("method") == "Log.entryAdded" and details["entry"]["level"] == "error":
            self.errors.append(
                re.sub(r"\s+", " ", details["entry"]["text"] + " " + details["entry"].get("url", ""))
            )
