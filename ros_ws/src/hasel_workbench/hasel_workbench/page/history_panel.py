"""The error falling step by step, the ledger, the next run, and export."""

from html import escape
from pathlib import Path
from typing import Any
from urllib.parse import quote

from hasel_sysid.answer.next_run import Suggestion
from nicegui import ui

from hasel_workbench.goal import goal_line
from hasel_workbench.page.html import parameter_table
from hasel_workbench.page.svg import waterfall_svg
from hasel_workbench.waterfall import waterfall


class HistoryPanel:
    """Drawn again when the session changes."""

    def __init__(self, page: Any) -> None:
        self._page = page
        self._start: ui.button | None = None
        with (
            ui.element("section")
            .classes("wb-card wb-of-runs wb-order-4")
            .props('aria-label="the error, step by step"')
        ):
            ui.html("<h2>The error, step by step</h2>", sanitize=False)
            self._steps()
        with (
            ui.element("section")
            .classes("wb-card wb-of-runs wb-order-4")
            .props('aria-label="next run and export"')
        ):
            ui.html("<h2>Next run, export</h2>", sanitize=False)
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
        session, state = self._page.session, self._page.session.state
        if not state.steps:
            return
        ui.html(waterfall_svg(waterfall(state)), sanitize=False)
        with ui.element("ol").classes("steps"):
            for number, step in enumerate(state.steps):
                with ui.element("li"):
                    here = number == state.at
                    button = ui.button(
                        ("● " if here else "○ ") + step.label,
                        on_click=lambda number=number: self._page.at_once(lambda: session.go_to(number)),
                    )
                    button.props(
                        f'dense flat no-caps size=sm aria-label="go to step {number}: {escape(step.label)}"'
                    )
                    button.set_enabled(not here or state.trial is not None)
                    unseen = "" if step.error_unseen is None else f", unseen {step.error_unseen:.4f}"
                    gone = " (taken back)" if number > state.at else ""
                    ui.label(f"{step.error:.4f}{unseen} · {step.file}{gone}")
        with ui.expansion("Parameters, at the start and now").classes("w-full").props("dense"):
            table = parameter_table(state.steps[0].model.parameters, state.shown.model.parameters)
            ui.html(table, sanitize=False)

    @ui.refreshable_method
    def _next(self) -> None:
        page, session, state = self._page, self._page.session, self._page.session.state
        with ui.element("div").classes("wb-buttons"):
            suggest = ui.button("Suggest the next run", on_click=lambda: page.do("suggest", session.suggest))
            suggest.props("dense no-caps outline").set_enabled(state.diagnosis is not None)
            export = ui.button("Export", on_click=self._export).props("dense no-caps outline")
            export.set_enabled(bool(state.steps))
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
        ui.html(f"<code>{escape(line)}</code>", sanitize=False)

        def work(progress) -> None:
            page.jobs.say("positive", page.rig.run(suggestion.manoeuvre, progress))

        self._start = ui.button("Start it on the rig", on_click=lambda: page.do("run on the rig", work))
        self._start.props("dense no-caps outline").set_enabled(page.rig.is_there)

    def _export(self) -> None:
        session = self._page.session

        def work(progress) -> None:
            session.export(None, progress)
            session.version += 1  # the links to the files

        self._page.do("export", work, f"Written to {session.folder / 'export'}.")


def exported(folder: Path) -> list[str]:
    """Every file of an export, the report first and pictures last."""
    files = [path for path in folder.rglob("*") if path.is_file()] if folder.is_dir() else []
    order = {suffix: number for number, suffix in enumerate((".html", ".py", ".yaml", ".svg", ".png"))}
    names = sorted(files, key=lambda path: (order.get(path.suffix, len(order)), path.name))
    return [path.relative_to(folder).as_posix() for path in names]
