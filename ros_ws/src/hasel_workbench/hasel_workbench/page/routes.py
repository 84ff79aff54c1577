"""What the page's canvases fetch: arrays of 32-bit numbers."""

import asyncio
from collections import OrderedDict

import numpy as np
from fastapi import Request, Response
from fastapi.responses import PlainTextResponse
from hasel_sim.errors import HaselSimError
from hasel_sim.run import Simulation
from hasel_sysid.errors import SysidError
from nicegui import app

from hasel_workbench.curves import curves
from hasel_workbench.failure_map import stretch
from hasel_workbench.film import film
from hasel_workbench.live.rig import RunningRig
from hasel_workbench.live.stream import KINDS
from hasel_workbench.packet import packet
from hasel_workbench.prediction import beyond_first_order
from hasel_workbench.state import SessionState
from hasel_workbench.workbench import Workbench

_KEPT_FILMS = 40


def add_routes(session: Workbench, rig: RunningRig) -> None:
    """`/data/…` of a session and of a rig."""
    films: OrderedDict[tuple[int, str], bytes] = OrderedDict()

    @app.get("/data/curves/{run}")
    def of_run(run: str) -> Response:
        return _answer(lambda: _curves(session.state, run))

    @app.get("/data/stretch/{run}/{cell}")
    def of_cell(run: str, cell: int) -> Response:
        return _answer(lambda: _stretch(session.state, run, cell))

    @app.get("/data/film/{run}")
    async def moving(run: str) -> Response:
        try:
            state = session.state
            key = (id(state.shown), run)
            if key not in films:
                films[key] = _film(state, run, await asyncio.wrap_future(session.true(run)))
                if len(films) > _KEPT_FILMS:
                    films.popitem(last=False)
        except (HaselSimError, SysidError) as error:
            return PlainTextResponse(str(error), 409)
        return _bytes(films[key])

    @app.post("/data/predict/{run}")
    async def foretold(run: str, request: Request) -> Response:
        values = await request.json()

        def made() -> bytes:
            found = session.predict(run, values)
            return packet({"error": found.error, "errorUnseen": found.error_unseen}, found.sin_theta)

        return _answer(made)

    @app.post("/data/truth/{run}")
    async def simulated(run: str, request: Request) -> Response:
        values = await request.json()
        try:
            state = session.state
            found = await asyncio.wrap_future(session.true(run, values))
            foretold = session.predict(run, values).sin_theta
        except (HaselSimError, SysidError) as error:
            return PlainTextResponse(str(error), 409)
        before = state.shown.simulations[state.number_of(run)].sin_theta
        header = {
            "film": len(found.sin_theta),
            "beyond": beyond_first_order(foretold, found.sin_theta, before),
        }
        return _bytes(packet(header, found.sin_theta) + _film(state, run, found))

    @app.post("/data/live")
    async def heard(request: Request) -> Response:
        return _bytes(_heard(rig, await request.json()))


def _curves(state: SessionState, run: str) -> bytes:
    made = curves(state, run)
    return packet(made.header(), made.rows)


def _stretch(state: SessionState, run: str, cell: int) -> bytes:
    number = state.number_of(run)
    begin, end = stretch(state.shown.comparison.runs[number].series, cell)
    return packet({"begin": begin, "end": end}, np.zeros(0))


def _film(state: SessionState, run: str, simulation: Simulation) -> bytes:
    number = state.number_of(run)
    offset = state.shown.comparison.runs[number].series.offset
    made = film(state.shown.model, state.every[number], simulation, offset)
    return packet(made.header(), made.frames)


def _heard(rig: RunningRig, seen: dict[str, int]) -> bytes:
    count, rows, error = dict(rig.stream.count), rig.stream.since(seen), rig.stream.error
    header = {
        "said": rig.said(),
        "seen": count,
        "counts": {kind: len(rows[kind]) for kind in KINDS},
        "error": None if error is None else error.mean_absolute,
        "recent": None if error is None else error.recent,
    }
    return packet(header, np.concatenate([rows[kind] for kind in KINDS]))


def _answer(made) -> Response:
    try:
        return _bytes(made())
    except (HaselSimError, SysidError) as error:
        return PlainTextResponse(str(error), 409)


def _bytes(content: bytes) -> Response:
    return Response(content, media_type="application/octet-stream", headers={"Cache-Control": "no-store"})
