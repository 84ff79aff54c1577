# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What is done to the model: the toolbar, values and effects that are tried, the steps so far, the next run, export."""

from functools import partial
from html import escape
from pathlib import Path
from typing import Any
from urllib.parse import quote

from hasel_sysid.answer.next_run import Suggestion
from hasel_sysid.report.wording import percent
from nicegui import ui

from hasel_workbench.cards import Card, sliders
from hasel_workbench.jobs import Progress
from hasel_workbench.live.rig import goal_line
from hasel_workbench.page.html import (
    button,
    card_text,
    markup,
    parameter_table,
    section,
    slider_row,
    waterfall_svg,
)
from hasel_workbench.state import waterfall

_BEYOND = (
    '<p id="wb-beyond" role="status" hidden>Beyond first order: the errors foretold above mislead here. The curve is '
    "the true simulation of this run; let go to simulate all runs.</p>"
)


class Toolbar:
    """Fit, diagnose, keep, take back, and how far it has come; drawn again when the session changes."""

    def __init__(self, page: Any) -> None:
        self._page = page
        self._usable: list[tuple[ui.button, bool]] = []
        with ui.element("div").classes("wb-tools"):
            self._buttons()
            self._text = ui.label().props('aria-live="polite"')
            self._bar = ui.linear_progress(0, show_value=False).classes("w-40").props('aria-label="progress"')
            self._cancel = button("cancel", page.jobs.cancel, "flat")

    def refresh(self) -> None:
        """Draw it again."""
        self._buttons.refresh()

    @ui.refreshable_method
    def _buttons(self) -> None:
        page, session, state = self._page, self._page.session, self._page.session.state
        there = bool(state.steps)
        with ui.element("div").classes("wb-buttons"):
            fit = button("Refit" if state.trial else "Fit", lambda: page.do("fit", session.fit), "unelevated")
            diagnose = button("Diagnose", lambda: page.do("diagnose", session.diagnose), "unelevated")
            self._usable = [(fit, there), (diagnose, there and state.trial is None)]
            if state.trial:
                keep = button("Keep", lambda: page.at_once(session.keep), "unelevated color=positive")
                self._usable.append((keep, True))
            back = button("Take back", lambda: page.at_once(session.take_back))
            self._usable.append((back, bool(state.trial) or state.at > 0))
            if state.trial:
                ui.label(f"{state.trial.label} is being tried: keep it as a step, or take it back.")
        self._enable(page.jobs.doing is None)

    def _enable(self, idle: bool) -> None:
        for each, usable in self._usable:
            each.set_enabled(usable and idle)

    def look(self) -> None:
        """Show how far what is under way has come."""
        doing = self._page.jobs.doing
        self._enable(doing is None)
        for element in (self._bar, self._cancel):
            element.set_visibility(doing is not None)
        self._text.set_text("" if doing is None else f"{doing.title}: {doing.text} ({doing.seconds:.0f} s)")
        self._bar.set_value(0.0 if doing is None else doing.share)


class EffectsPanel:
    """Effects, ranked, each with its card; what is tried, and its values under sliders."""

    def __init__(self, page: Any) -> None:
        self._page = page
        with section("values", "Values", "wb-of-runs wb-order-2"):
            markup("<p>Drag: the curve follows at once, the true simulation behind it.</p>")
            markup(_BEYOND)
            self._values()
        with section("effects", "Effects", "wb-of-runs wb-order-3"):
            self._effects()

    def refresh(self) -> None:
        """Draw it again."""
        self._values.refresh()
        self._effects.refresh()

    @ui.refreshable_method
    def _values(self) -> None:
        state = self._page.session.state
        if state.steps:
            markup("".join(map(slider_row, sliders(state.shown.model))))

    @ui.refreshable_method
    def _effects(self) -> None:
        state = self._page.session.state
        if not state.steps:
            return
        if state.diagnosis is None:
            markup("<p>Not ranked yet: diagnose, or try one by hand.</p>")
        else:
            for group in state.diagnosis.groups_in_question[:3]:
                ui.label(f"These recordings cannot tell apart: {', '.join(group)}.")
        with ui.element("div").classes("wb-effects"):
            for card in self._page.session.cards():
                self._effect(card)

    def _effect(self, card: Card) -> None:
        page, session, effect, finding = self._page, self._page.session, card.kind, card.finding
        change = session.switch_off if card.on else session.switch_on
        word = f"switch {'off' if card.on else 'on'}"
        said = f"{word} {effect.id}"
        with ui.element("div").classes("wb-effect").props(f'data-effect="{effect.id}"'):
            with ui.element("div").classes("line"):
                markup(f"<b>{effect.id}</b>")
                if card.on:
                    markup('<span class="chip on">on</span>')
                if finding is not None:
                    verdict = finding.verdict.value
                    markup(f'<span class="chip {verdict.replace(" ", "-")}">{verdict}</span>')
                    if finding.probability > 0.005:
                        markup(f'<span class="chip">probability {percent(finding.probability)}</span>')
                ui.element("div").classes("grow")
                switch = button(word, lambda: page.do(said, lambda progress: change(effect.id, progress)))
                switch.props(f'size=sm aria-label="{said}"').set_enabled(session.state.trial is None)
            markup(f"<p>{escape(effect.physics)}</p>")
            summary = f"<summary>{effect.place}: equation, values, sources</summary>"
            markup(f"<details>{summary}{card_text(card)}</details>")


class HistoryPanel:
    """The error falling step by step, the next run, and export; drawn again when the session changes."""

    def __init__(self, page: Any) -> None:
        self._page = page
        self._start: ui.button | None = None
        with section("the error, step by step", "The error, step by step", "wb-of-runs wb-order-4"):
            self._steps()
        with section("next run and export", "Next run, export", "wb-of-runs wb-order-4"):
            self._next()

    def refresh(self) -> None:
        """Draw it again."""
        self._steps.refresh()
        self._next.refresh()

    def look(self) -> None:
        """Follow whether there is a rig to make the proposed run."""
        if self._start is not None:
            self._start.set_enabled(self._page.rig.is_there)

    @ui.refreshable_method
    def _steps(self) -> None:
        page, session, state = self._page, self._page.session, self._page.session.state
        if not state.steps:
            return
        markup(waterfall_svg(waterfall(state)))
        with ui.element("ol").classes("steps"):
            for number, step in enumerate(state.steps):
                with ui.element("li"):
                    here = number == state.at
                    text = ("● " if here else "○ ") + step.label
                    there = partial(session.go_to, number)
                    go = button(text, partial(page.at_once, there), "flat size=sm")
                    go.props(f'aria-label="go to step {number}: {escape(step.label)}"')
                    go.set_enabled(not here or state.trial is not None)
                    unseen = "" if step.error_unseen is None else f", unseen {step.error_unseen:.4f}"
                    gone = " (taken back)" if number > state.at else ""
                    ui.label(f"{step.error:.4f}{unseen} · {step.file}{gone}")
        with ui.expansion("Parameters, at the start and now").classes("w-full").props("dense"):
            markup(parameter_table(state.steps[0].model.parameters, state.shown.model.parameters))

    @ui.refreshable_method
    def _next(self) -> None:
        page, session, state = self._page, self._page.session, self._page.session.state
        with ui.element("div").classes("wb-buttons"):
            suggest = button("Suggest the next run", lambda: page.do("suggest", session.suggest))
            suggest.set_enabled(state.diagnosis is not None)
            button("Export", self._export).set_enabled(bool(state.steps))
        self._start = None
        for suggestion in state.suggestions[:1]:
            self._suggestion(suggestion)
        files = exported(session.folder / "export")
        if files:
            with ui.element("ul").classes("wb-files"):
                for file in files:
                    with ui.element("li"):
                        ui.link(file, f"/export/{quote(file)}", new_tab=True)

    def _suggestion(self, suggestion: Suggestion) -> None:
        page, line = self._page, goal_line(suggestion.manoeuvre)
        ui.label(str(suggestion))
        if not line:
            return
        markup(f"<code>{escape(line)}</code>")

        def work(progress: Progress) -> None:
            page.jobs.say("positive", page.rig.run(suggestion.manoeuvre, progress))

        self._start = button("Start it on the rig", lambda: page.do("run on the rig", work))
        self._start.set_enabled(page.rig.is_there)

    def _export(self) -> None:
        session = self._page.session

        def work(progress: Progress) -> None:
            session.export(None, progress)
            session.version += 1  # the links to the files

        self._page.do("export", work, f"Written to {session.folder / 'export'}.")


def exported(folder: Path) -> list[str]:
    """Every file of an export, the report first and pictures last."""
    files = [path for path in folder.rglob("*") if path.is_file()] if folder.is_dir() else []
    order = {suffix: number for number, suffix in enumerate((".html", ".py", ".yaml", ".svg", ".png"))}
    names = sorted(files, key=lambda path: (order.get(path.suffix, len(order)), path.name))
    return [path.relative_to(folder).as_posix() for path in names]
