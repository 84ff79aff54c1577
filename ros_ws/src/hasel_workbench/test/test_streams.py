# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What a page draws: curves, the moving body and the map, as plain numbers."""

import numpy as np
import pytest
from hasel_sim.model import load_model
from hasel_sim.model_mesh import model_mesh
from hasel_workbench.curves import curves, failure_map, stretch
from hasel_workbench.film import axial_strain, film

RUN = "fit_5500V_2.0Hz"


@pytest.fixture
def shown(loaded):
    """A film of one run with what it is made of."""
    state = loaded.state
    number = state.number_of(RUN)
    truth = loaded.true(RUN).result()
    return film(
        state.shown.model, state.every[number], truth, state.shown.comparison.runs[number].series.offset
    ), truth


def test_the_film_shows_the_simulated_angle_and_the_measured_one(loaded, shown):
    """From the markers of both come the angles of both; every frame has nodes, strain and contraction."""
    made, truth = shown
    header, frames = made.header(), made.frames
    assert frames.dtype == np.float32
    assert header["width"] == 1 + header["muscles"] + 12 + 2 * header["nodes"] + len(header["rings"])
    at = np.searchsorted(truth.time, frames[:, 0] - 1e-4)
    assert _sine(frames[:, 3:9]) == pytest.approx(truth.sin_theta[at], abs=1e-4)
    state = loaded.state
    run = state.shown.comparison.runs[state.number_of(RUN)]
    measured = np.interp(frames[:, 0], run.series.time, run.series.measured - run.series.offset)
    assert _sine(frames[:, 9:15]) == pytest.approx(measured, abs=1e-4)


def test_strain_is_that_of_a_stretched_and_turned_body():
    """A body 10 % longer along its axis has 0.1 everywhere, however it is turned."""
    mesh = model_mesh(load_model("swimmer"))
    turn = np.array([[0.8, -0.6], [0.6, 0.8]])
    shapes = (mesh.nodes * (1.1, 1.0)) @ turn.T
    assert axial_strain(mesh, shapes[None]) == pytest.approx(0.1, abs=1e-9)


def test_curves_show_what_is_tried_beside_what_it_started_from(loaded):
    """Measured, simulated, and while something is being tried the step before, all about one offset."""
    assert curves(loaded.state, RUN).header()["rows"] == ["time", "measured", "simulated"]
    loaded.set_values({"slope": 0.3})
    made = curves(loaded.state, RUN)
    time, measured, simulated, before = made.rows
    assert np.abs(simulated - before).max() > 0.01
    residual = measured - simulated
    assert np.nanmean(residual) == pytest.approx(0.0, abs=1e-6)
    assert np.nanmean(np.abs(residual)) == pytest.approx(made.error, rel=1e-3)
    assert np.nanmean(np.abs(measured - before - np.nanmean(measured - before))) == pytest.approx(
        made.error_before, rel=1e-3
    )
    assert len(time) == made.header()["frames"]


def test_a_cell_of_the_map_leads_to_its_stretch(loaded):
    """The largest cell's stretch lies in that part of a cycle, and the residual there has its sign."""
    run = next(run for run in loaded.state.shown.comparison.runs if run.name == RUN)
    (row,) = [row for row in failure_map(loaded.state.shown.comparison.runs) if row.run == RUN]
    cell = int(np.nanargmax(np.abs(row.mean)))
    begin, end = stretch(run.series, cell)
    assert end - begin == pytest.approx(run.series.cycle.period / 20, rel=0.01)
    inside = (run.series.time >= begin) & (run.series.time <= end)
    assert np.sign(run.series.residual[inside].mean()) == np.sign(row.mean[cell])


def _sine(markers: np.ndarray) -> np.ndarray:
    head, middle, tail = markers.reshape(-1, 3, 2).astype(float).transpose(1, 0, 2)
    first, second = middle - head, tail - middle
    cross = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    return cross / (np.linalg.norm(first, axis=1) * np.linalg.norm(second, axis=1))
