# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The web server of the page; it loads nothing from elsewhere."""

import asyncio
import secrets
import socket
import webbrowser
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from threading import Thread

from fastapi.middleware.trustedhost import TrustedHostMiddleware
from hasel_sysid.errors import SysidError
from nicegui import app, background_tasks, run, ui

from hasel_workbench.jobs import Jobs
from hasel_workbench.live.rig import RunningRig
from hasel_workbench.page.access import LOOPBACK, Door, RedirectFile
from hasel_workbench.page.page import Page
from hasel_workbench.page.routes import add_routes
from hasel_workbench.workbench import Workbench

_STATIC = Path(__file__).with_name("static")
_SCRIPTS = ("packet.js", "body.js", "curves.js", "tuning.js", "live.js", "bench.js")


def serve(
    session: Workbench,
    jobs: Jobs,
    rig: RunningRig,
    host: str,
    port: int,
    show: bool,
    visit: Callable[[str], None] | None = None,
    certificate: tuple[Path, Path] | None = None,
) -> None:
    """Serve until interrupted; port 0: any that is free. certificate: its file and that of its key, for HTTPS.

    visit: called with the address, in a thread, once the server answers; after it the server ends. Raises SysidError
    where the port is taken.
    """
    port = _free_port(host, port)
    add_routes(app, session, rig)
    (session.folder / "export").mkdir(parents=True, exist_ok=True)
    app.add_static_files("/workbench", _STATIC)
    app.add_static_files("/export", session.folder / "export")
    token = secrets.token_urlsafe(24)
    app.add_middleware(Door, token=token, port=port)
    if host in LOOPBACK:  # the outermost: a page elsewhere may give its own name this machine's address
        app.add_middleware(TrustedHostMiddleware, allowed_hosts=list(LOOPBACK))
    head = '<link rel="stylesheet" href="/workbench/workbench.css">'
    head += "".join(f'<script src="/workbench/{name}"></script>' for name in _SCRIPTS)

    @ui.page("/", title="HASEL workbench", language="en-US")
    def page() -> None:
        ui.add_head_html(head)
        Page(session, jobs, rig).build()

    shown = "127.0.0.1" if host in ("0.0.0.0", "::") else f"[{host}]" if ":" in host else host
    address = f"{'http' if certificate is None else 'https'}://{shown}:{port}/?token={token}"
    told = f"The workbench is at {address} (Ctrl-C ends it); what is kept is in {session.folder}."

    async def opened() -> None:
        await _until_open(host, port)
        print(told, flush=True)
        if show:
            file = RedirectFile(address, session.folder)
            app.on_shutdown(file.remove)
            Thread(target=webbrowser.open, args=[file.uri], daemon=True).start()
        if visit is not None:
            try:
                await run.io_bound(visit, address)
            finally:
                app.shutdown()

    app.on_startup(lambda: background_tasks.create(opened()))
    secure = {} if certificate is None else {"ssl_certfile": certificate[0], "ssl_keyfile": certificate[1]}
    quiet = {"reload": False, "show": False, "show_welcome_message": False}
    ui.run(host=host, port=port, dark=None, title="HASEL workbench", favicon="〰️", **quiet, **secure)


async def _until_open(host: str, port: int) -> None:
    """Wait until the server answers."""
    while True:
        await asyncio.sleep(0.05)
        with suppress(OSError):
            _, writer = await asyncio.open_connection(host, port)
            writer.close()
            return


def _free_port(host: str, port: int) -> int:
    """The port, once it is known to be free."""
    with socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET) as tried:
        tried.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            tried.bind((host, port))
        except OverflowError:
            raise SysidError(f"--port is {port}, but 0 to 65535 is expected: give another one") from None
        except OSError as error:
            raise SysidError(
                f"{host} port {port} cannot be listened at ({error.strerror}): is a workbench there already? Otherwise "
                "give another --port, or --port 0 for any that is free"
            ) from None
        return tried.getsockname()[1]
