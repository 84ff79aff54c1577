# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Who may come in: whom the host lets in, the printed address' token, and the browser that is led to it."""

import secrets
from collections.abc import Awaitable, Callable, MutableMapping
from contextlib import suppress
from html import escape
from http.cookies import CookieError, SimpleCookie
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from urllib.parse import parse_qs, urlencode, urlsplit

from fastapi.datastructures import Headers
from fastapi.responses import PlainTextResponse, RedirectResponse
from hasel_sysid.errors import SysidError

LOOPBACK = ("127.0.0.1", "localhost", "::1")
LARGEST_REQUEST = 1 << 30
"""Bytes that one request, such as an upload, may have."""
Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]


def opening(host: str, certificate: tuple[Path, Path] | None, unencrypted: bool) -> str:
    """What listening at a host opens, in one sentence; '' for this machine only.

    Raises SysidError where others on the network would be let in without a certificate and without being told so.
    """
    if host in LOOPBACK:
        return ""
    opens = (
        f"--host {host} opens the workbench to the network: whoever has its address with the token can run experiments "
        "on the rig and read recordings and effect files"
    )
    if certificate is not None:
        return f"{opens}."
    if not unencrypted:
        raise SysidError(
            f"{opens}, and without encryption everybody on the way can read the token; give --certificate FILE --key "
            "FILE, or say --unencrypted where you trust the network"
        )
    return f"{opens}; without encryption everybody on the way can read the token."


class Door:
    """ASGI middleware. token: what the address carries once, and a cookie of this port from then on."""

    def __init__(self, app: Callable[[Scope, Receive, Send], Awaitable[None]], token: str, port: int) -> None:
        self._app, self._token, self._cookie = app, token, f"hasel_workbench_{port}"

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Hand on what may come in; refuse the rest in a sentence."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        refusal = self._refusal(scope, headers)
        if refusal is None and self._shown(scope):
            refusal = self._with_cookie(scope)
        if refusal is None:
            await self._app(scope, receive, send)
        elif scope["type"] == "websocket":
            await receive()
            await send({"type": "websocket.close", "code": 1008})
        else:
            await refusal(scope, receive, send)

    def _refusal(self, scope: Scope, headers: Headers) -> PlainTextResponse | None:
        origin = headers.get("origin")
        if origin is not None and urlsplit(origin).netloc != headers.get("host"):
            return PlainTextResponse("A page of another site asks: refused.", 403)
        if not self._is_token(self._kept(headers)) and not self._shown(scope):
            return PlainTextResponse("Open the address that the workbench printed, with its token.", 403)
        length = headers.get("content-length", "0")
        if headers.get("transfer-encoding"):
            return PlainTextResponse("Say how long the request is.", 411)
        if not length.isdecimal() or int(length) > LARGEST_REQUEST:
            return PlainTextResponse(f"A request has at most {LARGEST_REQUEST >> 20} MB.", 413)
        return None

    def _kept(self, headers: Headers) -> str:
        """The token that the browser keeps."""
        with suppress(CookieError, KeyError):
            return SimpleCookie(headers.get("cookie", ""))[self._cookie].value
        return ""

    def _shown(self, scope: Scope) -> bool:
        """Whether the address of a page carries the token."""
        given = parse_qs(scope["query_string"].decode("latin-1")).get("token", [""])[0]
        return scope["type"] == "http" and scope["method"] == "GET" and self._is_token(given)

    def _is_token(self, given: str) -> bool:
        return secrets.compare_digest(given.encode(), self._token.encode())

    def _with_cookie(self, scope: Scope) -> RedirectResponse:
        """To the same page without the token, which the browser keeps from now on and shows to no other site.

        Not strict: where a file or a link led here, the browser would not show it to that page either.
        """
        query = parse_qs(scope["query_string"].decode("latin-1"))
        query.pop("token")
        rest = urlencode(query, doseq=True)
        answer = RedirectResponse("/" + scope["path"].lstrip("/") + (f"?{rest}" if rest else ""), 303)
        is_secure = scope["scheme"] == "https"
        answer.set_cookie(self._cookie, self._token, httponly=True, samesite="lax", secure=is_secure)
        return answer


_PAGE = """<!DOCTYPE html>
<html lang="en">
<head><meta charset="utf-8"><meta http-equiv="refresh" content="0; url={0}"><title>HASEL workbench</title></head>
<body><a href="{0}">To the workbench</a></body>
</html>
"""


class RedirectFile:
    """uri: its address; below: where it is, in a folder of its own, as a browser in a snap sees no temporary files."""

    def __init__(self, address: str, below: Path) -> None:
        self._folder = TemporaryDirectory(prefix="open_", dir=below)
        path = Path(self._folder.name).resolve() / "workbench.html"
        path.touch(0o600)
        path.write_text(_PAGE.format(escape(address)), encoding="utf-8")
        self.uri = path.as_uri()

    def remove(self) -> None:
        """With its folder."""
        self._folder.cleanup()
