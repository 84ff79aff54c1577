# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Nobody comes into the page without the printed token, or from another site's page; the browser is led there."""

import os
import re
import subprocess
import sys
import time
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from hasel_sysid.errors import SysidError

pytest.importorskip("nicegui", reason="NiceGUI is not installed: the extra `page` of hasel_workbench")
from fastapi import FastAPI, Request, WebSocket, WebSocketDisconnect
from fastapi.responses import PlainTextResponse
from fastapi.testclient import TestClient
from hasel_workbench.page.access import LARGEST_REQUEST, Door, RedirectFile, opening
from hasel_workbench.page.page import free_path

TOKEN, SITE = "a-token-of-the-test", "http://127.0.0.1:8477"
COOKIE = {"Cookie": f"hasel_workbench_8477={TOKEN}"}
_START = "from hasel_workbench.command import main; import sys; sys.exit(main(sys.argv[1:]))"
_PATIENCE_S = 200.0


async def _answered(request: Request) -> PlainTextResponse:
    return PlainTextResponse("inside")


async def _hears(socket: WebSocket) -> None:
    await socket.accept()
    await socket.send_text("inside")
    await socket.close()


@pytest.fixture
def client() -> TestClient:
    """A page, data, files and a socket behind the door, as the workbench has them."""
    inner = FastAPI()
    inner.add_api_websocket_route("/socket.io/", _hears)
    app = FastAPI(docs_url=None, redoc_url=None, openapi_url=None)
    app.mount("/_nicegui_ws", inner)
    app.add_api_route("/{path:path}", _answered, methods=["GET", "POST"])
    app.add_middleware(Door, token=TOKEN, port=8477)
    return TestClient(app, base_url=SITE, follow_redirects=False)


@pytest.mark.parametrize(
    "path", ["/", "/data/curves/run", "/workbench/packet.js", "/export/report.html", "/docs"]
)
def test_without_the_token_nothing_is_answered(client, path):
    """No page, no data, no file: another user of this machine sees nothing, nor does one who guesses."""
    for guess in ("", "?token=", "?token=guess", f"?token={TOKEN}x"):
        assert client.get(path + guess).status_code == 403
    for kept in ("hasel_workbench_8477=guess", f"hasel_workbench_8478={TOKEN}", "\x01;;="):
        assert client.get(path, headers={"Cookie": kept}).status_code == 403
    assert client.post(f"{path}?token={TOKEN}").status_code == 403


def test_the_printed_address_opens_the_page(client):
    """The browser keeps the token, shows it to no other site and to no script, and the address loses it."""
    opened = client.get(f"/export/report.html?run=1&token={TOKEN}")
    assert (opened.status_code, opened.headers["location"]) == (303, "/export/report.html?run=1")
    assert "httponly" in opened.headers["set-cookie"].lower()
    assert "samesite=lax" in opened.headers["set-cookie"].lower()
    assert client.get("/", headers=COOKIE).text == "inside"


@pytest.mark.parametrize("origin", ["http://elsewhere.example", "http://127.0.0.1:8478", "null"])
def test_another_sites_page_is_refused(client, origin):
    """With the cookie even: a request or a socket of another origin gets nothing."""
    assert client.get("/", headers={**COOKIE, "Origin": origin}).status_code == 403
    assert client.post("/data/live", headers={**COOKIE, "Origin": origin}).status_code == 403
    with (
        pytest.raises(WebSocketDisconnect),
        client.websocket_connect("/_nicegui_ws/socket.io/", headers={**COOKIE, "Origin": origin}) as socket,
    ):
        socket.receive_text()


def test_sockets_want_the_token(client):
    """A socket without it is refused, also with it in the address; the page's own is not."""
    for path in ("/_nicegui_ws/socket.io/", f"/_nicegui_ws/socket.io/?token={TOKEN}"):
        with (
            pytest.raises(WebSocketDisconnect),
            client.websocket_connect(path, headers={"Origin": SITE}) as socket,
        ):
            socket.receive_text()
    with client.websocket_connect(
        "/_nicegui_ws/socket.io/", headers={**COOKIE, "Origin": SITE, "Host": "127.0.0.1:8477"}
    ) as socket:
        assert socket.receive_text() == "inside"


def test_a_huge_request_is_refused_unread(client):
    """What says to be larger than a gigabyte, or does not say how large it is, is not taken."""
    huge = {**COOKIE, "Content-Length": str(LARGEST_REQUEST + 1)}
    assert client.post("/data/live", headers=huge).status_code == 413
    assert client.post("/data/live", headers=COOKIE, content=iter([b"x"])).status_code == 411


@pytest.mark.parametrize("how", ["chunked", "Chunked", "gzip, CHUNKED", "identity"])
def test_a_request_that_does_not_say_its_length_is_refused(client, how):
    """In whatever spelling."""
    answer = client.post("/data/live", headers={**COOKIE, "Transfer-Encoding": how}, content=iter([b"{}"]))
    assert answer.status_code == 411


@pytest.mark.parametrize(
    "name", ["a.csv", "../../a.csv", "/etc/a.csv", "a\0.csv", 300 * "x" + "a.csv", "..", "", "."]
)
def test_an_upload_stays_below_its_folder(tmp_path, name):
    """Whatever it is called, a file can be written there, and one of its name stands in a folder beside it."""
    for folder in ("uploads", "uploads_2"):
        path = free_path(tmp_path / "uploads", name)
        assert path.resolve().parent == tmp_path / folder
        assert not path.exists()
        path.parent.mkdir()
        path.write_text("1")


def test_beyond_this_machine_is_said():
    """Another host is refused without a certificate or an explicit word, and says what it opens with either."""
    assert opening("127.0.0.1", None, False) == ""
    with pytest.raises(
        SysidError, match=r"opens the workbench to the network.*--certificate FILE.*--unencrypted"
    ):
        opening("0.0.0.0", None, False)
    assert "can run experiments" in opening("0.0.0.0", None, True)


def _path(uri: str) -> Path:
    assert urlsplit(uri).scheme == "file"
    return Path(unquote(urlsplit(uri).path))


def test_only_the_owner_can_read_it(tmp_path):
    """File and folder are private, whatever the mask, and gone in the end."""
    before = os.umask(0)
    try:
        file = RedirectFile('http://127.0.0.1:1/?a="1"&token=t', tmp_path)
    finally:
        os.umask(before)
    path = _path(file.uri)
    assert (path.stat().st_mode & 0o777, path.parent.stat().st_mode & 0o777) == (0o600, 0o700)
    assert 'content="0; url=http://127.0.0.1:1/?a=&quot;1&quot;&amp;token=t"' in path.read_text()
    file.remove()
    assert not list(tmp_path.iterdir())


@pytest.mark.timeout(500)
def test_the_command_line_of_the_browser_shows_no_token(tmp_path):
    """It is given a file, which leads to the printed address; with the workbench the file goes."""
    browser, told = tmp_path / "browser", tmp_path / "told"
    browser.write_text(f'#!/bin/sh\nprintf %s "$*" > {told}.part\nmv {told}.part {told}\n')
    browser.chmod(0o700)
    own = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    command = [sys.executable, "-c", _START, "--output", str(tmp_path / "out"), "--port", "0", "--no-rig"]
    served = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=own | {"BROWSER": str(browser)})
    try:
        address = re.search(r"http://\S+\?token=(\S+)", served.stdout.readline())
        end = time.monotonic() + _PATIENCE_S
        while not told.exists() and time.monotonic() < end:
            time.sleep(0.05)
        assert address[1] not in told.read_text()
        path = _path(told.read_text())
        assert address[0] in path.read_text()
    finally:
        served.terminate()
        served.communicate(timeout=30)
    assert not path.parent.exists()
