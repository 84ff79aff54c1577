# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What is asked of the data routes is answered, or refused in a sentence."""

from itertools import product

import pytest

pytest.importorskip("nicegui", reason="NiceGUI is not installed: the extra `page` of hasel_workbench")
from fastapi import FastAPI
from fastapi.testclient import TestClient
from hasel_workbench.live.rig import RunningRig
from hasel_workbench.page.routes import add_routes

RUN = "fit_4500V_3.5Hz"
ROUTES = (f"/data/predict/{RUN}", f"/data/truth/{RUN}", "/data/live")
JSON = {"Content-Type": "application/json"}
BODIES = {
    b"{": "no JSON, which was expected",
    b"\xff": "error parsing the body",
    100_000 * b"[": "error parsing the body",
    b"": "body is None",
    b"[1]": "body is [1]: Input should be a valid dictionary",
    b"3": "body is 3",
    b'{"a": "b"}': "body a is 'b': Input should be a valid",
    b'{"a": null}': "body a is None",
    b'{"\\ud800": []}': "is []",
}


@pytest.fixture
def client(loaded) -> TestClient:
    """The routes of a session with runs; an exception that is not answered is raised here."""
    app = FastAPI()
    add_routes(app, loaded, RunningRig())
    return TestClient(app)


def test_names_and_numbers_are_answered(client, loaded):
    """As the page sends them."""
    name = next(iter(loaded.state.shown.model.values))
    for route in ROUTES:
        assert client.post(route, json={}).status_code == 200
    assert client.post(ROUTES[0], json={name: loaded.state.shown.model.values[name]}).status_code == 200
    assert client.post(ROUTES[2], json={"measured": 3}).status_code == 200


def test_any_other_body_is_refused(client):
    """One short sentence that says what was found and what was expected, with status 400."""
    for route, (body, said) in product(ROUTES, BODIES.items()):
        answer = client.post(route, content=body, headers=JSON)
        assert (answer.status_code, said in answer.text) == (400, True), answer.text
        assert len(answer.text) < 300


@pytest.mark.parametrize("value", ["NaN", "-Infinity", "1e999", "1" + 400 * "0"])
def test_values_are_finite(client, loaded, value):
    """JSON knows no others, and no body has such values."""
    (name, *_) = loaded.state.shown.model.values
    for route in ROUTES[:2]:
        answer = client.post(route, content=f'{{"{name}": {value}}}', headers=JSON)
        assert (answer.status_code, f"body {name} is" in answer.text) == (400, True), answer.text


def test_what_is_not_there_is_said(client):
    """A run or a parameter, whatever it is called: with status 409."""
    for what in ("curves", "film"):
        answer = client.get(f"/data/{what}/nowhere")
        assert (answer.status_code, "there is no run 'nowhere'" in answer.text) == (409, True)
    for route, name in product(ROUTES[:2], ("nonsense", r"\ud800")):
        answer = client.post(route, content=f'{{"{name}": 1}}', headers=JSON)
        assert (answer.status_code, "parameter" in answer.text) == (409, True), answer.text
