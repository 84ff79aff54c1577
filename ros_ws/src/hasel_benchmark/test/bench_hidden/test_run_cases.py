# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Many cases: stopped, resumed, beside each other, failing."""

import json
import threading
from concurrent.futures import ThreadPoolExecutor

import pytest
from hasel_benchmark.bench_hidden import command, run_cases
from hasel_benchmark.bench_hidden.hidden_cases import Case
from hasel_benchmark.bench_hidden.laboratory import Laboratory
from hasel_benchmark.benchmark_commands import bench_hidden
from hasel_sim.errors import SimulationError
from hasel_sim.parallel import SerialExecutor
from hasel_sysid.errors import SysidError

CASES = [Case("nothing", (), 0.0, seed, "white", "near") for seed in range(3)]
ANSWER = {
    "noise_floor": 0.003,
    "stages": [{"effects": [], "parameters": {}, "mae_fit": 0.0024, "mae_validation": 0.0024}],
    "ranking": [],
    "indistinguishable": [],
    "verdict": {"status": "nothing_missing", "missing": [], "unexplained_fraction": 0.0},
}


@pytest.fixture(autouse=True)
def measured(monkeypatch):
    """Nothing is simulated here; the cases asked for are listed."""
    asked = []

    def measure(case, pool):
        asked.append(case)
        if case.seed == 99:
            raise SimulationError("it cannot be followed")
        return Laboratory((), (), {}, 0.0024, 0.0024)

    monkeypatch.setattr(run_cases, "measure", measure)
    return asked


def run(cases, folder, explain=lambda laboratory, pool: ANSWER):
    """All outcomes of some cases."""
    return list(run_cases.run_cases(cases, explain, SerialExecutor(), folder, lambda sentence: None))


def test_a_stopped_benchmark_goes_on_where_it_was(tmp_path, measured):
    """What was finished before Ctrl-C is kept, and only the rest is run again."""
    answers = iter([ANSWER])

    def stopped(laboratory, pool):
        try:
            return next(answers)
        except StopIteration:
            raise KeyboardInterrupt from None

    with pytest.raises(KeyboardInterrupt):
        run(CASES, tmp_path, stopped)
    measured.clear()
    assert [outcome.case for outcome in run(CASES, tmp_path)] == [case.name for case in CASES]
    assert measured == CASES[1:]


def test_cases_run_beside_each_other(tmp_path):
    """As many at once as there are workers, and every one ends in a file."""
    together = threading.Barrier(2, timeout=10.0)

    def met(laboratory, pool):
        together.wait()
        return ANSWER

    cases = [Case("nothing", (), 0.0, seed, "white", "near") for seed in range(4)]
    with ThreadPoolExecutor(2) as pool:
        outcomes = list(run_cases.run_cases(cases, met, pool, tmp_path, lambda sentence: None, at_once=2))
    assert {outcome.case for outcome in outcomes} == {path.stem for path in tmp_path.iterdir()}
    assert len(outcomes) == 4


def test_a_case_alone_has_all_workers(tmp_path):
    """Each is given the whole pool in its turn, and its outcome says how many cores that were."""
    with ThreadPoolExecutor(2) as pool:
        asked = []
        outcomes = list(
            run_cases.run_cases(
                CASES, lambda laboratory, own: asked.append(own) or ANSWER, pool, tmp_path, print, cores=2
            )
        )
    assert asked == [pool] * 3
    assert [outcome.cores for outcome in outcomes] == [2] * 3


def test_each_case_leaves_a_file_with_answer_and_truth(tmp_path):
    """One JSON file per case, complete."""
    run(CASES[:1], tmp_path)
    content = json.loads((tmp_path / f"{CASES[0].name}.json").read_text())
    assert content["answer"] == ANSWER
    assert content["case"]["kind"] == "nothing"
    assert [path.suffix for path in tmp_path.iterdir()] == [".json"]


def test_failures_are_outcomes(tmp_path):
    """A truth that cannot be simulated and an `improve` that gives up are told apart and stop nothing."""

    def give_up(laboratory, pool):
        raise SysidError("too little excitation")

    broken = Case("nothing", (), 0.0, 99, "white", "near")
    outcomes = run([broken, *CASES[:1]], tmp_path, give_up)
    assert "truth cannot be simulated" in outcomes[0].failure
    assert "improve gave up: too little excitation" in outcomes[1].failure


def test_command_refuses_to_mix_with_earlier_results(tmp_path, capsys):
    """A folder that holds results needs --resume, said in one sentence."""
    run(CASES[:1], tmp_path)
    assert bench_hidden(["--quick", "--output", str(tmp_path)]) == 1
    assert "--resume" in capsys.readouterr().err


def test_command_writes_the_page(tmp_path, monkeypatch):
    """Results go to a page and a JSON file beside it."""
    monkeypatch.setattr(command, "explain", lambda laboratory, pool: ANSWER)
    assert bench_hidden(["--quick", "--jobs", "1", "--output", str(tmp_path)]) == 0
    assert "nothing hidden, coloured noise: something reported | 0 % (0–79) | ≤ 2 % | yes" in (
        tmp_path / "hidden_effects.md"
    ).read_text(encoding="utf-8")
    assert json.loads((tmp_path / "hidden_effects.json").read_text())["near"]["bars"]


def test_command_goes_on_from_the_page_alone(tmp_path, monkeypatch, measured):
    """The JSON beside the page holds every outcome: with it, another machine need not begin again."""
    monkeypatch.setattr(command, "explain", lambda laboratory, pool: ANSWER)
    page = tmp_path / "page.md"
    asked = ["--quick", "--jobs", "1", "--page", str(page), "--output"]
    assert bench_hidden([*asked, str(tmp_path / "here")]) == 0
    first = page.read_text(encoding="utf-8")
    measured.clear()
    assert bench_hidden([*asked, str(tmp_path / "elsewhere"), "--resume"]) == 0
    assert (measured, page.read_text(encoding="utf-8")) == ([], first)


def test_command_hides_what_nobody_has_looked_at(tmp_path, monkeypatch, measured):
    """With --first-seed the draws are others, of all kinds, and the page is not the one of the whole benchmark."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(command, "explain", lambda laboratory, pool: ANSWER)
    assert bench_hidden(["--seeds", "2", "--first-seed", "6", "--jobs", "1", "--output", "fresh"]) == 0
    for kind in ("single", "pair", "unlisted"):
        assert {case.seed for case in measured if case.kind == kind} == {6, 7}
    assert (tmp_path / "fresh" / "hidden_effects.md").is_file()


def test_command_refuses_a_seed_below_zero(capsys):
    """Said in one sentence."""
    with pytest.raises(SystemExit):
        bench_hidden(["--first-seed", "-1"])
    assert "'-1' is no seed; give a whole number, 0 or more" in capsys.readouterr().err
