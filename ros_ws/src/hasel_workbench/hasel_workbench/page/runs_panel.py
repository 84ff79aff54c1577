"""Runs: load them, choose the one that is looked at, and see where the model fails."""

from html import escape
from typing import Any

from nicegui import ui

from hasel_workbench.failure_map import failure_map
from hasel_workbench.page.html import failure_map_table, runs_table


class RunsPanel:
    """Drawn again when the session changes."""

    def __init__(self, page: Any) -> None:
        self._page = page
        with ui.element("section").classes("wb-card").props('aria-label="runs"'):
            ui.html("<h2>Runs</h2>", sanitize=False)
            self._runs()
            with (
                ui.expansion("Load runs: drop .mcap or .csv files")
                .classes("w-full")
                .props("dense") as loading
            ):
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
        with (
            ui.element("section")
            .classes("wb-card wb-of-runs wb-order-4")
            .props('aria-label="where the model fails"')
        ):
            ui.html("<h2>Where it fails</h2>", sanitize=False)
            self._where()

    def refresh(self) -> None:
        """Draw it again."""
        self._runs.refresh()
        self._where.refresh()

    @ui.refreshable_method
    def _runs(self) -> None:
        state = self._page.session.state
        if state.steps:
            ui.html(runs_table(state.shown.comparison.runs), sanitize=False)
        else:
            ui.html("<p>None yet.</p>", sanitize=False)

    @ui.refreshable_method
    def _where(self) -> None:
        state = self._page.session.state
        if not state.steps:
            return
        comparison = state.shown.comparison
        said = "".join(f"<li>{escape(each)}</li>" for each in comparison.where.sentences())
        ui.html(
            f"<ul>{said}</ul><p>Measured minus simulated sin θ by run and part of the cycle: click a cell.</p>"
            + failure_map_table(failure_map(comparison.runs)),
            sanitize=False,
        )
