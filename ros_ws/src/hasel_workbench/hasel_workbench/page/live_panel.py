"""A running rig: measured against simulated as they come, the running error, and what was heard as runs to fit."""

from typing import Any

from nicegui import ui

from hasel_workbench.live.stream import WINDOW_S

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
    """Follows the rig once it is opened."""

    def __init__(self, page: Any) -> None:
        self._page = page
        with ui.element("section").classes("wb-card").props('aria-label="live"'):
            self._said = page.rig.said()
            self._open = ui.expansion("Live: a running rig", caption=self._said).classes("w-full")
            with self._open.props("dense"):
                ui.html(_CANVAS.format(window=WINDOW_S), sanitize=False).classes("w-full")
                with ui.element("div").classes("wb-buttons"):
                    self._heard = ui.button("Take what was heard as runs", on_click=self._take)
                    self._send = ui.button(_TAKE, on_click=self._model)
                    for button in (self._heard, self._send):
                        button.props("dense no-caps outline")
                ui.html(_HOW, sanitize=False)
            self._open.on_value_change(
                lambda event: ui.run_javascript(f"live.follow({str(event.value).lower()})")
            )

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
        page = self._page

        def work(progress) -> None:
            page.session.take(page.rig.recordings(page.session.folder / "heard"), False, progress)

        page.do("take what was heard", work)

    def _model(self) -> None:
        page = self._page

        def work(progress) -> None:
            page.jobs.say("positive", page.rig.load(page.session.model_file(), progress))

        page.do("the simulator takes the model", work)
