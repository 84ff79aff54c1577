# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What is looked at: runs and their columns, the map, the moving body and its curves, the live rig."""

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from hasel_recording.csv_columns import THETA_UNITS, TIME_UNITS
from hasel_recording.drive_channel import UNITS
from hasel_sim.model import Model
from nicegui import ui

from hasel_workbench.curves import failure_map
from hasel_workbench.jobs import Progress
from hasel_workbench.live.stream import WINDOW_S
from hasel_workbench.page.html import button, failure_map_table, markup, runs_table, section
from hasel_workbench.state import Unread


class RunsPanel:
    """Runs: load them, choose one to look at, see where the model fails; drawn again when the session changes."""

    def __init__(self, page: Any) -> None:
        self._page = page
        with section("runs", "Runs"):
            self._runs()
            loading = ui.expansion("Load runs: drop .mcap or .csv files").classes("w-full").props("dense")
            with loading:
                for label, unseen in (("runs to fit", False), ("unseen runs, never fitted", True)):
                    upload = ui.upload(
                        label=f"drop {label}",
                        multiple=True,
                        auto_upload=True,
                        on_multi_upload=lambda event, unseen=unseen: page.uploaded(event, unseen),
                    )
                    upload.props(f'flat bordered accept=".mcap,.csv,.db3" aria-label="{label}"')
                    upload.classes(f"wb-upload-{'unseen' if unseen else 'fitted'}")
            loading.set_value(not page.session.state.every)
        with section("where the model fails", "Where it fails", "wb-of-runs wb-order-4"):
            self._where()

    def refresh(self) -> None:
        """Draw it again."""
        self._runs.refresh()
        self._where.refresh()

    @ui.refreshable_method
    def _runs(self) -> None:
        state = self._page.session.state
        markup(runs_table(state.shown.comparison.runs) if state.steps else "<p>None yet.</p>")

    @ui.refreshable_method
    def _where(self) -> None:
        state = self._page.session.state
        if not state.steps:
            return
        comparison = state.shown.comparison
        said = "".join(f"<li>{escape(each)}</li>" for each in comparison.where.sentences())
        how = "<p>Measured minus simulated sin θ by run and part of the cycle: click a cell.</p>"
        markup(f"<ul>{said}</ul>{how}{failure_map_table(failure_map(comparison.runs))}")


_SINE, _NONE = "its sine", "–"


class ColumnsPanel:
    """Which column is which in files that could not be read for their names; drawn again when the session changes."""

    def __init__(self, page: Any) -> None:
        self._page = page
        self._asked = page.session.state.unread
        self._files()

    def refresh(self) -> None:
        """Draw it again; a new question comes into view."""
        self._files.refresh()
        before, self._asked = self._asked, self._page.session.state.unread
        if set(self._asked) - set(before):
            ui.run_javascript("bench.ask()")

    @ui.refreshable_method
    def _files(self) -> None:
        for unread in self._page.session.state.unread:
            self._file(unread)

    def _file(self, unread: Unread) -> None:
        page, session = self._page, self._page.session
        meant = session.reading.of(unread.path)
        chosen: dict[str, tuple[ui.select, ui.select]] = {}
        card = ui.element("section").classes("wb-card")
        with card.props('tabindex=-1 data-question aria-label="columns of a file"'):
            ui.label(f"Which column is which in {unread.path.name}?").classes("wb-title")
            if unread.said:
                ui.label(unread.said).classes("wb-banner error").props('role="alert"')
            for role, units in roles(session.model()):
                with ui.element("div").classes("wb-column-of"):
                    known, its_unit = already_known(role, units, unread.names, meant)
                    column = ui.select([_NONE, *unread.names], value=known, label=role).props("dense")
                    unit = ui.select(list(units), value=its_unit, label="in").props("dense")
                chosen[role] = column, unit

            def read() -> None:
                columns = named({role: (c.value, u.value) for role, (c, u) in chosen.items()})
                page.do("load", lambda progress: session.read_as(unread.path, columns, progress))

            with ui.element("div").classes("wb-buttons"):
                button("Read it so", read, "unelevated")
                button("Leave it out", lambda: page.at_once(lambda: session.pass_over(unread.path)))


def roles(model: Model) -> list[tuple[str, tuple[str, ...]]]:
    """What a column can be, and the units it can be in: time, angle, and the channels of the model."""
    channels = [channel.column for channel in model.description.channels]
    return [
        ("time", tuple(TIME_UNITS)),
        ("angle", (_SINE, *THETA_UNITS)),
        *((f"{each.quantity} of {each.name}", tuple(UNITS[each.quantity])) for each in channels),
    ]


def already_known(
    role: str, units: Sequence[str], names: Sequence[str], meant: Mapping[str, str]
) -> tuple[str, str]:
    """The column that was named, else the one called as expected, and its unit; a dash and the first unit for none."""
    expected = [(next(iter(named({role: ("", unit)}))), unit) for unit in units]
    known = [(meant[name], unit) for name, unit in expected if name in meant]
    known += [(name, unit) for name, unit in expected if name in names]
    return next((each for each in known if each[0] in names), (_NONE, units[0]))


def named(chosen: dict[str, tuple[str, str]]) -> dict[str, str]:
    """{name that is known here: column}, as of --map, of {role: (column, unit)}; a dash stands for none."""
    columns = {}
    for role, (column, unit) in chosen.items():
        if column == _NONE:
            continue
        if role == "time":
            columns[f"time_{unit}"] = column
        elif role == "angle":
            columns["sin_theta" if unit == _SINE else f"theta_{unit}"] = column
        else:
            quantity, _, channel = role.partition(" of ")
            columns[f"{quantity}_{channel}_{unit}"] = column
    return columns


_BODY = """
<h2>Motion <small id="wb-run-name"></small></h2>
<canvas id="wb-body" role="img" aria-label="The body moving, with simulated and measured markers"></canvas>
<div class="wb-player">
  <button id="wb-play" data-do="play" aria-label="play or pause (space)">▶ play</button>
  <input id="wb-scrub" type="range" min="0" max="1000" value="0" aria-label="time in the run (arrow keys)">
  <span id="wb-clock">0.00 s</span>
  <label>speed <select id="wb-speed" aria-label="speed"><option value="1">1</option><option value="0.5">1/2</option>
    <option value="0.25">1/4</option><option value="0.1">1/10</option></select></label>
  <label>colour <select id="wb-colour" aria-label="colour of the body"><option value="strain">strain</option>
    <option value="contraction">contraction</option></select></label>
</div>
<div class="wb-keys"><span id="wb-legend"></span> <span><i class="ring"></i>simulated markers</span>
<span><i class="full"></i>measured</span></div>
"""
_CURVE = """
<h2>Measured against simulated</h2>
<canvas id="wb-curve" tabindex="0" role="img" aria-label="sin θ over time, measured and simulated, and the residual;
arrow keys move the time"></canvas>
<div class="wb-keys"><span><i class="dot"></i>measured</span><span><i></i>simulated</span>
<span><i class="earlier"></i>before what is tried</span><span>tinted: driven</span>
<button class="wb-small" data-do="whole">whole run</button></div>
<p id="wb-said" role="status"></p>
"""


def view_panel() -> None:
    """Two cards; everything in them follows the run that this page has chosen."""
    markup(_BODY).classes("wb-card wb-of-runs wb-order-1")
    markup(_CURVE).classes("wb-card wb-of-runs wb-order-1")


_CANVAS = """
<canvas id="wb-live" role="img" aria-label="Measured and simulated sin θ of the running rig, and its voltages"></canvas>
<div class="wb-keys"><span><i class="dot"></i>measured</span><span><i></i>simulated</span>
<span><i class="upper"></i>upper voltage</span><span><i class="lower"></i>lower voltage</span></div>
<p id="wb-live-said" role="status" aria-live="polite"></p>
<div class="wb-numbers"><div><b id="wb-live-error">–</b><small>mean |Δ sin θ| in this run</small></div>
<div><b id="wb-live-recent">–</b><small>in its last {window:g} s</small></div></div>
"""
_HOW = """
<p>Start a rig with <code>ros2 launch hasel_bringup rig.launch.py</code>, or one without hardware with
<code>ros2 run hasel_bringup virtual_rig</code>. The workbench never arms: <code>ros2 service call /hasel/arm
std_srvs/srv/Trigger</code> does. STOP is at the top of the page.</p>
"""
_TAKE, _START = "Let the simulator take this model", "Start a simulator of this model"


class LivePanel:
    """A running rig: measured against simulated as they come, and what was heard as runs; followed once opened."""

    def __init__(self, page: Any) -> None:
        self._page = page
        with ui.element("section").classes("wb-card").props('aria-label="live"'):
            self._said = page.rig.said()
            self._open = ui.expansion("Live: a running rig", caption=self._said).classes("w-full")
            with self._open.props("dense"):
                markup(_CANVAS.format(window=WINDOW_S)).classes("w-full")
                with ui.element("div").classes("wb-buttons"):
                    self._heard = button("Take what was heard as runs", self._take)
                    self._send = button(_TAKE, self._model)
                markup(_HOW)
            opened = "live.follow({})".format
            self._open.on_value_change(lambda event: ui.run_javascript(opened(str(event.value).lower())))

    def look(self) -> None:
        """Follow what the rig does."""
        rig = self._page.rig
        if self._said != (said := "" if self._open.value else rig.said()):  # else it stands below the curves
            self._said = self._open.props["caption"] = said
            self._open.update()
        self._heard.set_enabled(bool(rig.stream.count["measured"]))
        self._send.set_enabled(rig.link is not None)
        self._send.set_text(_TAKE if rig.has_simulator else _START)

    def _take(self) -> None:
        page, folder = self._page, self._page.session.folder / "heard"
        page.do(
            "take what was heard",
            lambda progress: page.session.take(page.rig.recordings(folder), False, progress),
        )

    def _model(self) -> None:
        page = self._page

        def work(progress: Progress) -> None:
            page.jobs.say("positive", page.rig.load(page.session.model_file(), progress))

        page.do("the simulator takes the model", work)
