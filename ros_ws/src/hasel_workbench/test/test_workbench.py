# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The session: load, compare, diagnose, try, keep, take back, export; no page is needed."""

import json
import re
import subprocess
import sys
import time
from dataclasses import replace

import numpy as np
import pytest
from hasel_recording import read_recording
from hasel_recording.reading import distinct_names
from hasel_sim.model import load_model, save_model
from hasel_sysid.errors import SysidError
from hasel_workbench.jobs import Jobs
from hasel_workbench.session_files import script
from hasel_workbench.state import waterfall
from hasel_workbench.step import beyond_first_order


def test_the_four_steps(loaded):
    """The hidden effect comes first; switched on, the error falls on unseen runs too; taken back, it is as before."""
    loaded.diagnose()
    fitted = loaded.state.current
    assert [step.label for step in loaded.state.steps] == ["start", "fit"]
    best = loaded.cards()[0]
    assert (best.effect, best.verdict) == ("quadratic_drag", "missing")
    assert 0.2 <= best.finding.expected["quadratic_drag.coefficient"][0] < 0.3

    loaded.switch_on("quadratic_drag")
    trial = loaded.state.trial
    assert trial.error < 0.3 * fitted.error
    assert trial.error_unseen < 0.3 * fitted.error_unseen
    assert waterfall(loaded.state).tried
    assert loaded.cards()[0].on

    loaded.fit()  # what is being tried goes on being tried
    assert loaded.state.trial.label == "+ quadratic_drag"
    loaded.keep()
    assert loaded.state.trial is None
    assert [stage.label for stage in waterfall(loaded.state).stages] == ["start", "fit", "+ quadratic_drag"]
    kept = load_model(loaded.folder / loaded.state.current.file)
    assert kept.values == pytest.approx(loaded.state.current.model.values)

    loaded.take_back()
    assert loaded.state.current is fitted
    assert not any(card.on for card in loaded.cards())
    loaded.go_to(2)
    assert loaded.state.current.label == "+ quadratic_drag"
    loaded.go_to(1)
    lines = [json.loads(line) for line in (loaded.folder / "workbench.jsonl").read_text().splitlines()]
    assert [line["what"] for line in lines] == ["kept"] * 3 + ["taken back", "restored", "taken back"]
    assert all((loaded.folder / line["model"]).exists() for line in lines)

    loaded.suggest()
    differences = [suggestion.difference for suggestion in loaded.state.suggestions]
    assert len(differences) > 1
    assert differences == sorted(differences, reverse=True)
    assert differences[0] > differences[-1] > 0


def test_the_exported_script_does_it_all_again(new_session, short_runs, tmp_path):
    """Run by itself, it ends with the same model and the same errors."""
    session = new_session()
    session.load(short_runs[0][:1])
    session.switch_on("quadratic_drag")
    session.set_values({"quadratic_drag.coefficient": 0.3})
    session.keep()
    session.fit()
    written = {path.name for path in session.export(tmp_path / "export")}
    assert {"model.yaml", "report.html", "session.py", "waterfall.svg", "waterfall.png"} <= written
    assert "fit_4500V_3.5Hz.svg" in written
    done = subprocess.run(
        [sys.executable, "session.py"],
        cwd=tmp_path / "export",
        capture_output=True,
        text=True,
        timeout=100,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    for step in session.state.kept:
        assert f"{step.label}: mean |Δ sin θ| = {step.error:.5f}" in done.stdout
    again = load_model(tmp_path / "export" / "model_again.yaml").values
    assert again == pytest.approx(load_model(tmp_path / "export" / "model.yaml").values, rel=1e-3)


def test_the_report_of_twelve_runs_stays_small(new_session, unseen_rig, tmp_path):
    """Two megabytes at most, with three steps."""
    session, rig = new_session(), unseen_rig / "quadratic_drag"
    session.load(sorted(rig.glob("val_*.csv")), unseen=True)
    session.load(sorted(rig.glob("fit_*.csv")))
    for effect in ("quadratic_drag", "linear_drag"):
        session.switch_on(effect)
        session.keep()
    assert (len(session.state.every), len(session.state.kept)) == (12, 3)
    session.export(tmp_path / "export")
    assert (tmp_path / "export" / "report.html").stat().st_size < 2_000_000


def test_a_small_change_is_foretold_by_the_derivatives(loaded):
    """Curve and errors of the linear prediction are those of the true simulation, to second order."""
    state = loaded.state
    value = state.current.model.values["amplitude_5500"]
    values = {"amplitude_5500": 1.02 * value}
    foretold = loaded.predict("fit_5500V_2.0Hz", values)
    truth = loaded.true("fit_5500V_2.0Hz", values).result()
    before = state.current.simulations[state.number_of("fit_5500V_2.0Hz")]
    moved = np.abs(truth.sin_theta - before.sin_theta).max()
    assert moved > 0.002
    assert np.abs(foretold.sin_theta - truth.sin_theta).max() < 0.15 * moved

    loaded.set_values(values)
    trial = loaded.state.trial
    assert trial.model.values["amplitude_5500"] == pytest.approx(1.02 * value)
    assert foretold.error == pytest.approx(trial.error, rel=0.01)
    assert foretold.error_unseen == pytest.approx(trial.error_unseen, rel=0.01)


def test_values_stay_within_their_bounds(loaded):
    """A slope below what the model allows is the lowest that it allows."""
    loaded.set_values({"slope": -3.0})
    assert loaded.state.trial.model.values["slope"] == loaded.state.current.model.parameters["slope"].lower


def test_an_effect_can_be_tried_before_any_diagnosis(loaded):
    """At its typical size; the card says what it is; switched off again, the model is the one before."""
    loaded.switch_on("quadratic_drag")
    effect = next(card for card in loaded.cards() if card.effect == "quadratic_drag")
    assert effect.on and effect.kind.equation and effect.parameters and effect.finding is None
    loaded.keep()
    loaded.switch_off("quadratic_drag")
    assert loaded.state.trial.error == pytest.approx(loaded.state.steps[0].error)
    with pytest.raises(SysidError, match="'− quadratic_drag' is being tried; keep it or take it back first"):
        loaded.diagnose()


def test_what_cannot_be_read_is_a_banner(loaded, unseen_rig, tmp_path):
    """A truncated file, a run that is there already and a missing file get a sentence each; the session goes on."""
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(b"\x89MCAP0\r\n\x00\x01")
    known = unseen_rig / "quadratic_drag" / "fit_5500V_2.0Hz.csv"
    steps = loaded.state.steps
    loaded.load([cut, tmp_path / "none.csv"])
    loaded.load([known])
    texts = [banner.text for banner in loaded.state.banners]
    assert any("cut.mcap" in text for text in texts)
    assert any("none.csv" in text for text in texts)
    assert any("is loaded already" in text for text in texts)
    assert loaded.state.steps == steps
    loaded.dismiss()
    assert loaded.state.banners == ()


def test_what_the_data_check_finds_is_a_banner(new_session, short_runs, tmp_path):
    """With how bad it is; the run is shown all the same."""
    dead = dead_channel(short_runs[0][0], tmp_path / "one_sided.csv")
    session = new_session()
    session.load([dead])
    assert [
        (b.severity, "the lower muscle never gets a voltage" in b.text) for b in session.state.banners
    ] == [("warning", True)]
    assert len(session.state.every) == 1


def dead_channel(run, path):
    """The run with a lower muscle that gets no voltage."""
    lines = run.read_text().splitlines()
    rows = (line.split(",") for line in lines[1:])
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join([lines[0], *(",".join([time, up, "0", sine]) for time, up, _, sine in rows)]))
    return path


def test_a_banner_goes_with_what_it_is_about(loaded, short_runs, tmp_path):
    """A removed run's warning, and the error of a file that can be read now; said twice, it is there once."""
    known = loaded.state.every[0].recording.path
    loaded.load([dead_channel(short_runs[0][0], tmp_path / "dead.csv")])
    loaded.load([known])
    loaded.load([known])
    assert ["is loaded already" in each.text for each in loaded.state.banners] == [False, True]
    loaded.remove("dead")
    assert ["is loaded already" in each.text for each in loaded.state.banners] == [True]
    late = tmp_path / "late.csv"
    loaded.load([late])
    assert len(loaded.state.banners) == 2
    late.write_text(short_runs[0][0].read_text())
    loaded.load([late])
    assert ["is loaded already" in each.text for each in loaded.state.banners] == [True]


def test_a_file_whose_columns_are_asked_for_is_no_banner(loaded, short_runs, tmp_path):
    """The question says what is needed, without an option of a command or a folder, until it is answered or left."""
    path = tmp_path / "lab.csv"
    path.write_text(short_runs[0][0].read_text().replace("time_s", "t").replace("sin_theta", "bend"))
    loaded.load([path])
    assert loaded.state.banners == ()
    assert [each.said for each in loaded.state.unread] == [""]
    for columns, said in (
        ({"time_s": "t"}, "expected a time and an angle"),
        ({"time_s": "bend"}, "expected a time"),
    ):
        loaded.read_as(path, columns)
        assert said in loaded.state.unread[0].said
    loaded.read_as(path, {"time_s": "bend", "sin_theta": "t"})  # times that go back
    (unread,) = loaded.state.unread
    assert "lab.csv" in unread.said and str(tmp_path) not in unread.said
    assert loaded.state.banners == ()
    loaded.pass_over(path)
    assert (loaded.state.unread, loaded.state.banners) == ((), ())


def test_runs_of_two_folders_are_called_as_by_the_commands(new_session, short_runs, tmp_path):
    """Also those that were there first, in what is said of them and in every step."""
    paths = [tmp_path / f"day{n}" / "a.csv" for n in (1, 2)]
    for path, run in zip(paths, short_runs[0], strict=True):
        dead_channel(run, path)
    session = new_session()
    for path in paths:
        session.load([path])
    expected = distinct_names(paths)
    assert expected == ["day1_a", "day2_a"]
    assert [each.name for each in session.state.every] == expected
    assert [each.name for each in session.state.current.comparison.runs] == expected
    assert session.state.banners[-1].text.startswith("day2_a")


def test_what_was_taken_is_not_taken_twice(new_session, short_runs):
    """Of what a rig was heard to do only the new runs are added, without a word about the others."""
    session = new_session()
    first, second = (read_recording(path) for path in short_runs[0])
    session.take([first])
    session.take([first, second])
    assert [each.name for each in session.state.experiments] == [first.name, second.name]
    assert session.state.banners == ()
    with pytest.raises(SysidError, match="nothing new: all 2 runs are loaded already"):
        session.take([first, second])


def test_there_is_a_model_for_the_simulator_before_any_run(new_session, short_runs):
    """The one that was asked for; later, the one that is shown."""
    session = new_session(model="beam")
    assert load_model(session.model_file()).name == "beam"
    session = new_session()
    session.load(short_runs[0][:1])
    session.set_values({"slope": 0.3})
    assert load_model(session.model_file()).values == pytest.approx(session.state.trial.model.values)


def test_more_runs_judge_every_step_anew(loaded, unseen_rig):
    """The history stays, with the errors that it has on all runs there are now."""
    loaded.switch_on("quadratic_drag")
    loaded.keep()
    before = [step.error for step in loaded.state.steps]
    loaded.load([unseen_rig / "quadratic_drag" / "fit_3500V_3.5Hz.csv"])
    after = loaded.state.steps
    assert [step.label for step in after] == ["start", "+ quadratic_drag"]
    assert all(len(step.comparison.runs) == 4 for step in after)
    assert [step.error for step in after] != before


def test_a_page_is_told_what_how_many_of_how_many_and_the_time_left(loaded):
    """In the text beside the bar, of a fit and of the diagnosis that goes on from it."""
    jobs, seen = Jobs(), {}
    jobs.start("diagnose", loaded.diagnose)
    while (doing := jobs.doing) is not None:
        seen[doing.text] = doing.share
        time.sleep(0.01)
    assert [each.text for each in jobs.said] == []
    told = re.compile(r"(.*), (\d+) of (?:about )?(\d+) simulations, about \d:\d\d:\d\d left")
    found = [match for match in map(told.fullmatch, seen) if match]
    stages = {match[1].partition(":")[0] for match in found}
    assert {"fit", "every effect at its typical size"} <= stages
    assert all(int(match[2]) <= int(match[3]) for match in found)
    shares = list(seen.values())
    assert shares == sorted(shares)
    assert 0.0 < shares[len(shares) // 2] < 1.0


def test_nothing_changes_where_work_is_broken_off(loaded):
    """A progress that raises leaves the session as it was, and free for the next work."""

    def cancelled(_text, share):
        if share > 0.01:
            raise KeyboardInterrupt

    version = loaded.version
    with pytest.raises(KeyboardInterrupt):
        loaded.fit(cancelled)
    assert loaded.version == version
    loaded.set_values({"slope": 0.4})


@pytest.mark.parametrize(
    ("act", "sentence"),
    [
        (lambda s: s.keep(), "nothing is being tried"),
        (lambda s: s.take_back(), "this is the first step"),
        (lambda s: s.go_to(7), "there is no step 7"),
        (lambda s: s.suggest(), "diagnose first"),
        (lambda s: s.predict("fit_1V", {}), "there is no run 'fit_1V'"),
    ],
)
def test_what_cannot_be_done_is_a_sentence(loaded, act, sentence):
    """With what to do instead."""
    with pytest.raises(SysidError, match=sentence):
        act(loaded)


def test_an_empty_session_asks_for_runs(new_session):
    """Nothing can be fitted yet."""
    with pytest.raises(SysidError, match=r"drop \.csv or \.mcap files"):
        new_session().fit()


def _columns_panel():
    panel = pytest.importorskip("hasel_workbench.page.runs_panels", reason="NiceGUI is not installed")
    return panel.named, panel.roles


def test_columns_are_named_for_a_file_that_could_not_be_read(loaded, short_runs, tmp_path):
    """Other names than those that are known: the file waits until its columns are named; the script reads it so."""
    named, roles = _columns_panel()
    path = tmp_path / "lab.csv"
    text = short_runs[0][0].read_text().replace("time_s", "t").replace("sin_theta", "bend")
    path.write_text(text)
    loaded.load([path], unseen=True)
    (unread,) = loaded.state.unread
    assert unread.path == path
    assert {"t", "bend"} <= set(unread.names)
    assert [role for role, _ in roles(loaded.model())] == [
        "time",
        "angle",
        "voltage of upper",
        "voltage of lower",
    ]
    columns = named({"time": ("t", "s"), "angle": ("bend", "its sine"), "voltage of upper": ("–", "v")})
    loaded.read_as(path, columns)
    assert loaded.state.unread == ()
    assert [each.name for each in loaded.state.unseen] == ["val_5200V_2.5Hz", "lab"]
    said = script(loaded.state, loaded.reading)
    assert said.count("h.load(") == 3
    assert "start.yaml" in said.split('"""')[1]
    assert "columns={'time_s': 't', 'sin_theta': 'bend'}" in said
    broken = tmp_path / "broken.csv"
    broken.write_text(text.replace("bend", "sin_theta").replace("t,", "time_s,", 1) + "x,y\n")
    loaded.load([broken])
    assert loaded.state.unread == ()  # its columns are known: what is wrong is a row


def test_a_run_is_removed_or_made_unseen(loaded):
    """Every step is judged anew by what is left; one run to fit must stay."""
    first, second = (each.name for each in loaded.state.experiments)
    before = loaded.state.current.error
    loaded.set_unseen(first, True)
    assert [each.name for each in loaded.state.experiments] == [second]
    assert [run.unseen for run in loaded.state.current.comparison.runs] == [False, True, True]
    assert loaded.state.current.error != before
    with pytest.raises(SysidError, match="no run to fit would be left"):
        loaded.remove(second)
    loaded.set_unseen(first, False)
    loaded.remove(second)
    assert [each.name for each in loaded.state.every] == [first, "val_5200V_2.5Hz"]


def test_beyond_first_order_is_told(loaded):
    """A small change is foretold well enough; one of the whole range is not."""
    run = loaded.state.every[0].name
    value = loaded.state.shown.model.values["slope"]
    shown = loaded.state.shown.simulations[0].sin_theta
    for factor, told in ((1.02, False), (0.1, True)):
        values = {"slope": factor * value}
        true = loaded.true(run, values, False).result().sin_theta
        assert beyond_first_order(loaded.predict(run, values).sin_theta, true, shown) is told


def test_a_header_does_not_run_code(new_session, short_runs, tmp_path, monkeypatch):
    """A recording that names a model with an effect of its own is refused, unless the model is asked for."""
    monkeypatch.chdir(tmp_path)
    save_model(load_model("swimmer"), tmp_path / "x.yaml")
    (tmp_path / "x.yaml").write_text(
        (tmp_path / "x.yaml").read_text().replace("effects: []", "effects: ['x.py:X']")
    )
    (tmp_path / "x.py").write_text("raise SystemExit('it ran')")
    run = read_recording(short_runs[0][0])
    stranger = replace(run, path=None, metadata={"model": "x.yaml"})
    with pytest.raises(SysidError, match=r"x\.py:X, which is code that would run: give --model x.yaml"):
        new_session().take([stranger])
    with pytest.raises(SystemExit, match="it ran"):
        new_session(model="x.yaml").take([stranger])
