"""What is done to the session: fit, diagnose, keep, take back; and how far it has come."""

from typing import Any

from nicegui import ui


class Toolbar:
    """Drawn again when the session changes."""

    def __init__(self, page: Any) -> None:
        self._page = page
        self._usable: list[tuple[ui.button, bool]] = []
        with ui.element("div").classes("wb-tools"):
            self._buttons()
            self._text = ui.label().props('aria-live="polite"')
            self._bar = ui.linear_progress(0, show_value=False).classes("w-40").props('aria-label="progress"')
            self._cancel = ui.button("cancel", on_click=page.jobs.cancel).props("dense flat no-caps")

    def refresh(self) -> None:
        """Draw it again."""
        self._buttons.refresh()

    @ui.refreshable_method
    def _buttons(self) -> None:
        page, session, state = self._page, self._page.session, self._page.session.state
        there, self._usable = bool(state.steps), []
        with ui.element("div").classes("wb-buttons"):
            fit = ui.button("Refit" if state.trial else "Fit", on_click=lambda: page.do("fit", session.fit))
            diagnose = ui.button("Diagnose", on_click=lambda: page.do("diagnose", session.diagnose))
            for button, usable in ((fit, there), (diagnose, there and state.trial is None)):
                button.props("dense no-caps unelevated")
                self._usable.append((button, usable))
            if state.trial:
                keep = ui.button("Keep", on_click=lambda: page.at_once(session.keep))
                keep.props("dense no-caps unelevated color=positive")
                self._usable.append((keep, True))
            back = ui.button("Take back", on_click=lambda: page.at_once(session.take_back))
            back.props("dense no-caps outline")
            self._usable.append((back, bool(state.trial) or state.at > 0))
            if state.trial:
                ui.label(f"{state.trial.label} is being tried: keep it as a step, or take it back.")
        self._enable(page.jobs.doing is None)

    def _enable(self, idle: bool) -> None:
        for button, usable in self._usable:
            button.set_enabled(usable and idle)

    def look(self) -> None:
        """Show how far what is under way has come."""
        doing = self._page.jobs.doing
        self._enable(doing is None)
        for element in (self._bar, self._cancel):
            element.set_visibility(doing is not None)
        self._text.set_text("" if doing is None else f"{doing.title}: {doing.text} ({doing.seconds:.0f} s)")
        self._bar.set_value(0.0 if doing is None else doing.share)
