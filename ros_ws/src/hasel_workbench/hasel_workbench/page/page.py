# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""One browser page on the session: its parts, and what happens when something changes."""

from collections.abc import Callable
from html import escape
from itertools import chain, count
from pathlib import Path

from hasel_sysid.errors import SysidError
from hasel_sysid.report.wording import error_text
from nicegui import ui
from nicegui.events import GenericEventArguments, MultiUploadEventArguments

from hasel_workbench.jobs import Jobs, Progress
from hasel_workbench.live.rig import RunningRig
from hasel_workbench.page.html import button, markup
from hasel_workbench.page.model_panels import EffectsPanel, HistoryPanel, Toolbar
from hasel_workbench.page.runs_panels import ColumnsPanel, LivePanel, RunsPanel, view_panel
from hasel_workbench.state import noise_floor
from hasel_workbench.workbench import Workbench

_LOOK_S = 0.2
_LONGEST_NAME = 120


class Page:
    """session, jobs, rig: shared by all pages; what one page has of its own is in its browser."""

    def __init__(self, session: Workbench, jobs: Jobs, rig: RunningRig) -> None:
        self.session, self.jobs, self.rig = session, jobs, rig
        self._built, self._drawn = session.version, -1
        self._told = jobs.said[-1].number if jobs.said else 0
        self._values: dict[str, float] = {}

    def build(self) -> None:
        """Lay it out, and begin to look for changes."""
        self.dark = ui.dark_mode(None)
        with ui.element("header").classes("wb-head"):
            markup("<h1>HASEL workbench</h1>")
            self._numbers()
            with ui.element("div").classes("wb-corner"):
                darker = ui.button(icon="dark_mode", on_click=self._darker)
                darker.props('dense flat round aria-label="light or dark"')
                self.stop = ui.button("STOP", on_click=self._stop).classes("wb-stop")
                self.stop.props('color=negative no-caps aria-label="emergency stop: ground the high voltage"')
            tools = Toolbar(self)
        with ui.element("main").classes("wb-grid"):
            with ui.element("div").classes("wb-column"):
                self.banners()
                columns = ColumnsPanel(self)
                runs = RunsPanel(self)
            with ui.element("div").classes("wb-column middle"):
                live = LivePanel(self)
                view_panel()
                history = HistoryPanel(self)
            with ui.element("div").classes("wb-column"):
                effects = EffectsPanel(self)
        self._panels = (tools, columns, runs, history, effects)
        self._live, self._tools, self._history = live, tools, history
        ui.on("wb-values", self._let_go)
        ui.on("wb-act", self._act)
        ui.timer(_LOOK_S, self._look)

    def do(self, title: str, work: Callable[[Progress], object], done: str = "") -> None:
        """Begin long work; where something else is under way, say so."""
        self.at_once(lambda: self.jobs.start(title, work, done))

    def at_once(self, act: Callable[[], object]) -> None:
        """Do what takes no time; what cannot be done is told."""
        try:
            act()
        except SysidError as error:
            ui.notify(str(error), type="warning")

    async def uploaded(self, event: MultiUploadEventArguments, unseen: bool) -> None:
        """Keep the files that were dropped and load them."""
        paths = []
        for file in event.files:
            path = free_path(self.session.folder / "uploads", file.name)
            path.parent.mkdir(parents=True, exist_ok=True)
            await file.save(path)
            paths.append(path)
        self.do("load", lambda progress: self.session.load(paths, unseen, progress))

    @ui.refreshable_method
    def _numbers(self) -> None:
        state = self.session.state
        if not state.steps:
            markup("<p>Drop recordings to begin, or open Live beside a running rig.</p>")
            return
        shown = state.shown
        tried = f", tried: {escape(state.trial.label)}" if state.trial else ""
        model = escape(" + ".join((shown.model.name, *shown.effects)))
        numbers = [("wb-error", shown.error, "mean |Δ sin θ|, fitted runs")]
        if shown.error_unseen is not None:
            numbers.append(("wb-error-unseen", shown.error_unseen, "unseen runs"))
        numbers.append(("wb-noise", noise_floor(state), "noise floor"))
        cells = [(f'<b id="{name}">{error_text(value)}</b>', label) for name, value, label in numbers]
        cells = [(f"<b>{model}</b>", f"model{tried}"), *cells]
        text = "".join(f"<div>{bold}<small>{label}</small></div>" for bold, label in cells)
        markup(f'<div class="wb-numbers" aria-live="polite">{text}</div>')

    @ui.refreshable_method
    def banners(self) -> None:
        """What must be seen before any number."""
        found = self.session.state.banners
        for banner in found:
            shown = markup(f"<b>{banner.severity}</b> {escape(banner.text)}")
            shown.classes(f"wb-banner {banner.severity}").props('role="alert"')
        if found:
            button("I have read these", lambda: self.at_once(self.session.dismiss), "flat")

    def _look(self) -> None:
        """What has changed since the last look?"""
        version = self.session.version
        if self._built != version:
            self._built = version
            self._numbers.refresh()
            self.banners.refresh()
            for panel in self._panels:
                panel.refresh()
        if self._drawn != version:
            self._drawn = version
            names = [each.name for each in self.session.state.every] if self.session.state.steps else []
            ui.run_javascript(f"bench.refresh({version}, {names!r})")
        doing = self.jobs.doing
        self._tools.look()
        for said in [each for each in self.jobs.said if each.number > self._told]:
            self._told = said.number
            ui.notify(said.text, type=said.severity, multi_line=True, timeout=8000)
        if doing is None and self._values:
            values, self._values = self._values, {}
            self.do("simulate all runs", lambda progress: self.session.set_values(values, progress))
        self._live.look()
        self._history.look()
        self.stop.set_enabled(self.rig.link is not None)  # also while the rig is silent

    def _act(self, event: GenericEventArguments) -> None:
        """What a run's own buttons ask for."""
        run, act, session = event.args["run"], event.args["act"], self.session
        if act == "remove":
            self.do(f"remove {run}", lambda progress: session.remove(run, progress))
        else:
            self.do(f"{act} {run}", lambda progress: session.set_unseen(run, act == "unseen", progress))

    def _let_go(self, event: GenericEventArguments) -> None:
        self._values |= {name: float(value) for name, value in event.args.items()}

    async def _darker(self) -> None:
        if self.dark.value is None:  # as the system has it
            self.dark.value = await ui.run_javascript("document.body.classList.contains('body--dark')")
        self.dark.value = not self.dark.value

    async def _stop(self) -> None:
        self.jobs.say("negative", await self.rig.stop())


def free_path(folder: Path, name: str) -> Path:
    """A path in a folder, of the end of this name, that no file has yet; the folder is numbered where one has it."""
    name = Path(name.replace("\0", "")).name[-_LONGEST_NAME:]
    name = name if name.strip(".") else "recording"
    folders = chain([folder], (folder.with_name(f"{folder.name}_{number}") for number in count(2)))
    return next(path for path in (each / name for each in folders) if not path.exists())
