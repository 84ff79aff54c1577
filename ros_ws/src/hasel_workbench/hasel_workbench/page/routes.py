# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What the page's canvases fetch: arrays of 32-bit numbers."""

import asyncio
import json
import reprlib
from collections import OrderedDict
from collections.abc import Awaitable, Callable
from typing import Any

import numpy as np
from fastapi import APIRouter, FastAPI, Request, Response
from fastapi.exceptions import RequestValidationError
from fastapi.routing import APIRoute
from hasel_sim.errors import HaselSimError
from hasel_sim.run import Simulation
from hasel_sysid.errors import SysidError
from pydantic import FiniteFloat

from hasel_workbench.curves import curves, stretch
from hasel_workbench.film import film
from hasel_workbench.live.rig import RunningRig
from hasel_workbench.live.stream import KINDS
from hasel_workbench.state import SessionState
from hasel_workbench.step import beyond_first_order
from hasel_workbench.workbench import Workbench

_KEPT_FILMS = 40


def add_routes(app: FastAPI, session: Workbench, rig: RunningRig) -> None:
    """`/data/…` of a session and of a rig."""
    films: OrderedDict[tuple[int, str], bytes] = OrderedDict()
    data = APIRouter(prefix="/data", route_class=_InASentence)

    @data.get("/curves/{run}")
    def of_run(run: str) -> Response:
        made = curves(session.state, run)
        return _bytes(packet(made.header(), made.rows))

    @data.get("/stretch/{run}/{cell}")
    def of_cell(run: str, cell: int) -> Response:
        state = session.state
        begin, end = stretch(state.shown.comparison.runs[state.number_of(run)].series, cell)
        return _bytes(packet({"begin": begin, "end": end}, np.zeros(0)))

    @data.get("/film/{run}")
    async def moving(run: str) -> Response:
        state = session.state
        key = (id(state.shown), run)
        if key not in films:
            films[key] = _film(state, run, await asyncio.wrap_future(session.true(run)))
            if len(films) > _KEPT_FILMS:
                films.popitem(last=False)
        return _bytes(films[key])

    @data.post("/predict/{run}")
    async def foretold(run: str, values: dict[str, FiniteFloat]) -> Response:
        found = session.predict(run, values)
        return _bytes(packet({"error": found.error, "errorUnseen": found.error_unseen}, found.sin_theta))

    @data.post("/truth/{run}")
    async def simulated(run: str, values: dict[str, FiniteFloat]) -> Response:
        state = session.state
        found = await asyncio.wrap_future(session.true(run, values))
        foretold = session.predict(run, values).sin_theta
        before = state.shown.simulations[state.number_of(run)].sin_theta
        beyond = beyond_first_order(foretold, found.sin_theta, before)
        header = {"film": len(found.sin_theta), "beyond": beyond}
        return _bytes(packet(header, found.sin_theta) + _film(state, run, found))

    @data.post("/live")
    async def heard(seen: dict[str, int]) -> Response:
        count, rows, error = dict(rig.stream.count), rig.stream.since(seen), rig.stream.error
        header = {
            "said": rig.said(),
            "seen": count,
            "counts": {kind: len(rows[kind]) for kind in KINDS},
            "error": None if error is None else error.mean_absolute,
            "recent": None if error is None else error.recent,
        }
        return _bytes(packet(header, np.concatenate([rows[kind] for kind in KINDS])))

    app.include_router(data)


class _InASentence(APIRoute):
    """What is not as the route's types say is refused with status 400, what cannot be answered with 409."""

    def get_route_handler(self) -> Callable[[Request], Awaitable[Response]]:
        answer = super().get_route_handler()

        async def answered(request: Request) -> Response:
            try:
                return await answer(request)
            except (HaselSimError, SysidError) as error:
                said, status = str(error), 409
            except RequestValidationError as error:
                said, status = _unexpected(error.errors()[0]), 400
            return Response(said.encode(errors="replace"), status, media_type="text/plain")

        return answered


def _unexpected(found: dict[str, Any]) -> str:
    if found["type"] == "json_invalid":
        return f"The request's body is no JSON, which was expected: {found['ctx']['error']}."
    place = " ".join(map(str, found["loc"]))
    return f"The request's {place} is {reprlib.repr(found['input'])}: {found['msg']}."


def _film(state: SessionState, run: str, simulation: Simulation) -> bytes:
    number = state.number_of(run)
    offset = state.shown.comparison.runs[number].series.offset
    made = film(state.shown.model, state.every[number], simulation, offset)
    return packet(made.header(), made.frames)


def _bytes(content: bytes) -> Response:
    return Response(content, media_type="application/octet-stream", headers={"Cache-Control": "no-store"})


def packet(header: dict[str, Any], numbers: np.ndarray) -> bytes:
    """Length of the header (little-endian, 4 bytes), the header as JSON padded with blanks to a multiple of four bytes,
    and the numbers, little-endian, row by row.
    """
    text = json.dumps(header, ensure_ascii=False, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    return len(text).to_bytes(4, "little") + text + np.ascontiguousarray(numbers, dtype="<f4").tobytes()
