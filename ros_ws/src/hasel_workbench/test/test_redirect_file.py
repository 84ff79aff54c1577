"""The browser is opened without telling every user of the machine the token."""

import os
import re
import subprocess
import sys
import time
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from hasel_workbench.page.redirect_file import RedirectFile

pytest.importorskip("nicegui", reason="NiceGUI is not installed: the extra `page` of hasel_workbench")
_START = "from hasel_workbench.command import main; import sys; sys.exit(main(sys.argv[1:]))"
_PATIENCE_S = 200.0


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
