# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The benchmark measures what it says."""

import json
from dataclasses import replace

import numpy as np
import pytest
from hasel_common.measured_bar import MeasuredBar
from hasel_sim.bench import cases
from hasel_sim.bench.cases import (
    box_run,
    first_run_seconds,
    fitted_swimmer,
    node_count,
    processor_seconds,
    shares,
    swimmer_with_every_force,
    with_nodes,
)
from hasel_sim.bench.convergence import mesh_errors, step_errors
from hasel_sim.bench.effect_costs import measure_effects
from hasel_sim.bench.speed import (
    SideBySide,
    Speed,
    SpeedReport,
    free_swim_factor,
    measure_side_by_side,
    measure_speed,
    measure_swimming,
)
from hasel_sim.commands import bench, entry
from hasel_sim.effects.registry import catalogue
from hasel_sim.mechanics.banded import BandMatrix
from hasel_sim.model_mesh import model_mesh
from hasel_sim.simulate import simulate, simulate_many
from threadpoolctl import threadpool_limits

QUADRATIC_DRAG = catalogue()["quadratic_drag"]


def test_a_mesh_of_about_so_many_nodes_is_found():
    """Within some ten per cent, the default's own number exactly."""
    model = fitted_swimmer()
    assert node_count(with_nodes(model, 275)) == 275
    assert node_count(with_nodes(model, 1400)) == pytest.approx(1400, rel=0.1)


def test_the_run_alternates_at_its_frequency():
    """Four switches in a second at 2 Hz, upper muscle first."""
    schedule = box_run().schedule
    assert schedule.switches() == pytest.approx([0.0, 0.25, 0.5, 0.75])
    assert schedule.at(np.array([0.1, 0.3])).tolist() == [[5500, 0], [0, 5500]]


def test_a_step_costs_few_solutions_of_its_linear_system(monkeypatch):
    """No more than 1.5 times what they cost today: 1.0, 2.3 with sensitivities, 2.7 there and back by the adjoint."""
    asked = []

    def counted(model, times):
        asked.append(times)
        return cases.band_solutions(model, times)

    monkeypatch.setattr("hasel_sim.bench.speed.band_solutions", counted)
    with threadpool_limits(1):
        speed = measure_speed(fitted_swimmer())
    assert asked == [240]
    assert speed.solutions_per_step < 1.5
    assert speed.sensitivities / speed.band_solutions < 3.5
    assert (speed.forward + speed.adjoint) / speed.band_solutions < 4.0
    assert "275 nodes" in str(speed)


def test_runs_side_by_side_cost_less_than_one_after_the_other():
    """At least 1.3 times: half of what they save on a quiet machine."""
    with threadpool_limits(1):
        lanes = measure_side_by_side(fitted_swimmer().with_numerics(mesh_density=0.7))
    assert lanes.runs == 4
    assert lanes.forward_ratio > 1.3
    assert lanes.sensitivities_ratio > 1.3


def test_speed_is_stated_beside_real_time():
    """A second of motion in 0.1 s is 10 times real time, and twice what LAPACK takes in 0.05 s."""
    speed = Speed(275, 4, forward=0.1, sensitivities=0.2, adjoint=0.1, band_solutions=0.05)
    assert speed.real_time_factor == pytest.approx(10)
    assert speed.solutions_per_step == pytest.approx(2)


def test_works_are_timed_in_turns():
    """Each as often as said, after a first round."""
    calls = []
    processor_seconds([lambda: calls.append("a"), lambda: calls.append("b")], repeats=2)
    assert "".join(calls) == "ababab"


def test_the_first_call_is_not_counted():
    """It compiles, and would be half of a mean of two."""
    sizes = iter([3_000_000, 0])
    assert processor_seconds([lambda: sum(range(next(sizes)))], repeats=1)[0] < 0.01


def test_the_reference_solves_as_large_and_wide_a_system(monkeypatch):
    """As many unknowns and diagonals as the default mesh's matrix, so many times."""
    seen = []
    monkeypatch.setattr(cases.lapack, "dgbsv", lambda *arguments: seen.append(arguments))
    cases.band_solutions(fitted_swimmer(), 3)()
    below, above, band, right_hand_side = seen[0]
    matrix = BandMatrix(model_mesh(fitted_swimmer()).reach)
    assert len(seen) == 3
    assert below == above == matrix.half_bandwidth
    assert band.shape == (3 * below + 1, matrix.unknowns)
    assert right_hand_side.shape == (2 * 275,)


def test_the_profile_accounts_for_all_time():
    """Shares sum to one, and every kernel was seen."""
    found = shares(fitted_swimmer())
    assert sum(share for _, share in found) == pytest.approx(1.0)
    assert all(share > 0 for _, share in found)


def test_a_missed_bar_is_not_met():
    """In either direction."""
    assert not MeasuredBar("speed", 4.0, 5.0, at_least=True).met
    assert not MeasuredBar("cost", 3.0, 2.0).met
    assert MeasuredBar("cost", 1.0, 2.0).met


@pytest.mark.slow
def test_the_first_run_compiles_within_half_a_minute():
    """On a machine that has compiled nothing."""
    assert first_run_seconds() < 30


@pytest.mark.slow
def test_mesh_and_time_step_converge():
    """Errors fall with refinement; reduced quadrature converges faster; the default step is good to 0.001."""
    errors = {(e.quadrature_order, e.mesh_density): e.error for e in mesh_errors()}
    for order in (2, 3):
        ordered = [errors[order, d] for d in (0.5, 1.0, 2.0, 3.0)]
        assert ordered == sorted(ordered, reverse=True)
    assert errors[2, 1.0] < errors[3, 1.0]
    assert errors[2, 1.5] < 0.002
    steps = {e.steps_per_second: e.error for e in step_errors()}
    assert steps[240.0] < 1e-3
    assert steps[120.0] / steps[480.0] == pytest.approx(16, rel=0.3)


def test_the_command_prints_tables_and_writes_json(tmp_path, monkeypatch, capsys):
    """Exit status 1 when a bar is missed."""
    speed = measure_speed(fitted_swimmer().with_numerics(mesh_density=0.3))
    lanes = SideBySide(4, 1.0, 0.25, 3.0, 1.5)
    report = SpeedReport(40.0, [speed], speed, speed, 1.0, [(0, 1.0)], lanes, [("all", 1.0)], 6.0)
    monkeypatch.setattr(bench, "measure_speeds", lambda console: report)
    path = tmp_path / "bench.json"
    assert entry.bench(["--json", str(path)]) == 1
    values = json.loads(path.read_text())
    assert values["bars"][-1] == {
        "what": "first run, compiling (s)",
        "measured": 40.0,
        "limit": 30,
        "at_least": False,
        "met": False,
    }
    assert values["bars"][-2]["measured"] == pytest.approx(4.0)
    printed = capsys.readouterr().out.lower()
    assert "where the time goes" in printed
    assert "side by side" in printed


def test_swims_alone_are_timed_on_request(tmp_path, monkeypatch, capsys):
    """A free swim and a sweep beside their bars, and how busy the machine was; exit status 1 when one is missed."""
    report = measure_swimming(2.0, (5500.0,), (2.0, 2.5))
    assert report.swims == 2 and report.sweep > 0 and report.free_swim > 0
    for sweep, missed in ((100.0, 0), (301.0, 1)):
        slow = replace(report, sweep=sweep, free_swim=6.0)
        monkeypatch.setattr(bench, "measure_swimming", lambda slow=slow: slow)
        assert entry.bench(["--swimming", "--json", str(tmp_path / "bench.json")]) == missed
    assert [b["met"] for b in json.loads((tmp_path / "bench.json").read_text())["bars"]] == [True, False]
    assert "processes were at work" in capsys.readouterr().out


def test_a_free_swim_costs_little_more_than_its_effects_must():
    """With five forces of the fluid at least a fourteenth of the speed of the dry body (a sixth on a quiet machine)."""
    model, wet, run = fitted_swimmer(), swimmer_with_every_force(), box_run(0.5)
    with threadpool_limits(1):
        dry_time, wet_time = processor_seconds([lambda: simulate(model, run), lambda: simulate(wet, run)], 3)
        factor = free_swim_factor(0.5)
    assert wet_time < 14 * dry_time
    assert factor == pytest.approx(0.5 / wet_time, rel=0.6)


def test_every_effect_is_timed_over_the_run_without_it(monkeypatch):
    """In the catalogue's order; forward over the baseline's forward, sensitivities over the same forward run."""
    monkeypatch.setattr(
        "hasel_sim.bench.effect_costs.catalogue", lambda: dict.fromkeys(["quadratic_drag"], QUADRATIC_DRAG)
    )
    monkeypatch.setattr(
        "hasel_sim.bench.effect_costs.processor_seconds", lambda works, repeats: [2.0, 4.0, 3.0, 7.5]
    )
    report = measure_effects(1, 0.05)
    assert (report.baseline_s, report.baseline_sensitivities) == (2.0, 2.0)
    (cost,) = report.effects
    assert (cost.id, cost.forward, cost.sensitivities) == ("quadratic_drag", 1.5, 2.5)
    assert [bar.met for bar in report.bars()] == [False, False, False]


def test_what_is_timed_of_an_effect_runs(monkeypatch):
    """Four runs forward and with all sensitivities, with the effect at its typical values."""
    monkeypatch.setattr(
        "hasel_sim.bench.effect_costs.catalogue", lambda: dict.fromkeys(["quadratic_drag"], QUADRATIC_DRAG)
    )
    asked = []

    def timed(works, repeats):
        for work in works:
            work()
        return [1.0] * len(works)

    def counted(cases, names):
        asked.append((len(cases), sorted(cases[0][0].effects, key=str) != [], len(names)))
        return simulate_many(cases, names)

    monkeypatch.setattr("hasel_sim.bench.effect_costs.processor_seconds", timed)
    monkeypatch.setattr("hasel_sim.bench.effect_costs.simulate_many", counted)
    measure_effects(1, 0.05)
    assert asked == [(4, False, 0), (4, False, 4), (4, True, 0), (4, True, 5)]
