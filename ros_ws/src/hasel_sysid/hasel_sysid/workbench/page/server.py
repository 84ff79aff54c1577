"""The web server of the page; it loads nothing from elsewhere."""

import asyncio
import socket
from collections.abc import Callable
from pathlib import Path

from fastapi.middleware.trustedhost import TrustedHostMiddleware
from nicegui import app, background_tasks, run, ui

from hasel_sysid.errors import SysidError
from hasel_sysid.workbench.jobs import Jobs
from hasel_sysid.workbench.live.rig import Rig
from hasel_sysid.workbench.page.page import Page
from hasel_sysid.workbench.page.routes import add_routes
from hasel_sysid.workbench.workbench import Workbench

_STATIC = Path(__file__).with_name("static")
_SCRIPTS = ("packet.js", "body.js", "curves.js", "tuning.js", "live.js", "bench.js")
LOOPBACK = ("127.0.0.1", "localhost", "::1")


def serve(
    session: Workbench,
    jobs: Jobs,
    rig: Rig,
    host: str,
    port: int,
    show: bool,
    visit: Callable[[str], None] | None = None,
) -> None:
    """Serve until interrupted; port 0: any that is free.

    visit: called with the address, in a thread, once the server answers; after it the server ends. Raises SysidError
    where the port is taken.
    """
    port = _free_port(host, port)
    add_routes(session, rig)
    (session.folder / "export").mkdir(parents=True, exist_ok=True)
    app.add_static_files("/workbench", _STATIC)
    app.add_static_files("/export", session.folder / "export")
    if host in LOOPBACK:  # a page elsewhere cannot reach it by giving its own name this machine's address
        app.add_middleware(TrustedHostMiddleware, allowed_hosts=list(LOOPBACK))
    head = '<link rel="stylesheet" href="/workbench/workbench.css">'
    head += "".join(f'<script src="/workbench/{name}"></script>' for name in _SCRIPTS)

    @ui.page("/", title="HASEL workbench", language="en-US")
    def page() -> None:
        ui.add_head_html(head)
        Page(session, jobs, rig).build()

    address = f"http://{'127.0.0.1' if host in ('0.0.0.0', '::') else host}:{port}/"
    told = f"The workbench is at {address} (Ctrl-C ends it); what is kept is in {session.folder}."

    async def opened() -> None:
        await _until_open(host, port)
        print(told, flush=True)
        if visit is not None:
            try:
                await run.io_bound(visit, address)
            finally:
                app.shutdown()

    app.on_startup(lambda: background_tasks.create(opened()))
    ui.run(
        host=host,
        port=port,
        reload=False,
        show=show,
        dark=None,
        title="HASEL workbench",
        favicon="〰️",
        show_welcome_message=False,
    )


async def _until_open(host: str, port: int) -> None:
    """Wait until the server answers."""
    while True:
        await asyncio.sleep(0.05)
        try:
            _, writer = await asyncio.open_connection(host, port)
        except OSError:
            continue
        writer.close()
        return


def _free_port(host: str, port: int) -> int:
    """The port, once it is known to be free."""
    with socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET) as tried:
        tried.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            tried.bind((host, port))
        except OSError as error:
            raise SysidError(
                f"{host} port {port} cannot be listened at ({error.strerror}): is a workbench there already? Otherwise "
                "give another --port, or --port 0 for any that is free"
            ) from None
        return tried.getsockname()[1]
