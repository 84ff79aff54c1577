"""A running rig: measured against simulated as they come, the running error, and what was heard as runs to fit."""

from typing import Any

from nicegui import ui

_CANVAS = """
<canvas id="wb-live" role="img" aria-label="Measured and simulated sin θ of the running rig, and its voltages"></canvas>
<p id="wb-live-said" role="status" aria-live="polite"></p>
"""


class LivePanel:
    """Follows the rig once it is opened."""

    def __init__(self, page: Any) -> None:
        self._page = page
        with ui.element("section").classes("wb-card").props('aria-label="live"'):
            with ui.expansion("Live: a running rig").classes("w-full").props("dense") as self._open:
                ui.html(_CANVAS, sanitize=False)
                with ui.element("div").classes("wb-buttons"):
                    self._buttons = [
                        ui.button("Take what was heard as runs", on_click=self._take),
                        ui.button("Let the simulator take this model", on_click=self._send),
                    ]
                    for button in self._buttons:
                        button.props("dense no-caps outline")
                ui.html(
                    "<p>The workbench never arms: use the driver's own tools. STOP is at the top of the page.</p>",
                    sanitize=False,
                )
            self._open.on_value_change(
                lambda event: ui.run_javascript(f"live.follow({str(event.value).lower()})")
            )

    def look(self) -> None:
        """Follow what the rig does."""
        for button in self._buttons:
            button.set_enabled(self._page.rig.is_there)

    def _take(self) -> None:
        page = self._page

        def work(progress) -> None:
            page.session.take(page.rig.stream.recordings(page.session.folder / "heard"), False, progress)

        page.do("take what was heard", work)

    def _send(self) -> None:
        page = self._page

        def work(_progress) -> None:
            page.jobs.say("positive", page.rig.load(page.session.model_file()))

        page.do("the simulator takes the model", work)
