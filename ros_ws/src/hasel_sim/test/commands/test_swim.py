# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`swim`."""

import json

import pytest
from hasel_sim.commands.entry import numbers, swim_parser
from hasel_sim.commands.entry import swim as main
from hasel_sim.model import load_model, save_model


@pytest.fixture(scope="module")
def model_file(tmp_path_factory):
    """A coarse swimmer in oil with an uncertain viscosity."""
    model = load_model("swimmer_in_oil").with_numerics(mesh_density=0.5, steps_per_second=120.0)
    path = tmp_path_factory.mktemp("model") / "fish.yaml"
    model = model.with_freed("medium.viscosity_pa_s")
    save_model(model.with_values({"medium.viscosity_pa_s": 0.07}, {"medium.viscosity_pa_s": 0.007}), path)
    return path


def test_a_sweep_ends_in_a_table_a_picture_and_numbers(tmp_path, capsys, model_file):
    """Speeds by voltage and frequency, the optimum with its interval, what a constant does to it; and again at once."""
    command = [
        *("--model", str(model_file), "--voltage", "5500,5500/5000", "--frequency", "1.5,2,2.5,3"),
        *("--duration", "2.7", "--free", "body.depth_m=0.04:0.06:2", "--output", str(tmp_path / "out")),
        *("--json", str(tmp_path / "swim.json"), "--jobs", "1"),
    ]
    assert main(command) == 0
    said = capsys.readouterr().out
    assert "optimum 2." in said and "95 % interval" in said and "body.depth_m, m" in said
    found = json.loads((tmp_path / "swim.json").read_text())
    assert [len(curve) for curve in found["swims"].values()] == [4, 4]
    low, high = found["optima"]["5500 V"]["interval_hz"]
    assert low < found["optima"]["5500 V"]["frequency"] < high
    assert abs(found["swims"]["5500/5000 V"][1]["turning_rad_per_s"]) > 1e-3
    depths = [found["free"]["body.depth_m"][d]["optima"]["5500 V"]["frequency"] for d in ("0.04", "0.06")]
    assert depths[0] > depths[1]
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert {"swim.csv", "swim.png", "body_depth_m.png", "body_depth_m_0.04.csv"} <= names


def test_a_dask_cluster_swims_the_same(tmp_path, model_file):
    """A sweep and its interval on a cluster of this machine, against the same without one."""
    from distributed import LocalCluster

    command = [
        "--model",
        str(model_file),
        "--voltage",
        "5500",
        "--frequency",
        "1.5,2,2.5",
        "--duration",
        "2.7",
    ]
    found = []
    with LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None) as cluster:
        for name, by in (("here", ["--jobs", "1"]), ("there", ["--scheduler", cluster.scheduler_address])):
            path = tmp_path / f"{name}.json"
            assert main([*command, *by, "--output", str(tmp_path / name), "--json", str(path)]) == 0
            found.append(json.loads(path.read_text())["optima"]["5500 V"])
    here, there = found
    assert not here["at_edge"]
    assert there["interval_hz"] == pytest.approx(here["interval_hz"], rel=1e-6)
    assert there["speed"] == pytest.approx(here["speed"], rel=1e-9)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--model", "swimmer"], "names no fluid"),
        (["--frequency", "1", "--duration", "1"], "hold 1 periods of 1 Hz"),
        (["--set", "body.depht_m=0.04"], "the nearest known one is 'body.depth_m'"),
    ],
)
def test_what_cannot_swim_is_one_sentence(tmp_path, capsys, arguments, said):
    """A dry body, a swim that is too short, a name that is none."""
    assert main([*arguments, "--output", str(tmp_path), "--jobs", "1"]) == 1
    error = capsys.readouterr().err
    assert said in error and error.count("\n") == 1


@pytest.mark.parametrize(
    ("option", "value"),
    [
        ("--frequency", "1:10:0"),
        ("--voltage", "5500/4500/3"),
        ("--free", "body.depth_m=0.06:0.03"),
        ("--set", "slope"),
        ("--duration", "1,2"),
    ],
)
def test_options_that_make_no_sense_are_refused(capsys, option, value):
    """With what was expected."""
    with pytest.raises(SystemExit):
        swim_parser().parse_args([option, value])
    assert "expected" in capsys.readouterr().err


def test_ranges_include_their_end():
    """1:10:0.5 are nineteen frequencies."""
    assert len(numbers("1:10:0.5")) == 19
    assert numbers("1:10:0.5")[-1] == 10.0
