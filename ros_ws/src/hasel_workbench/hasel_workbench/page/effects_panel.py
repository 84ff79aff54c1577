"""Effects, ranked, each with its card; what is tried, and its values under sliders."""

from html import escape
from typing import Any

from hasel_sysid.report.wording import percent
from nicegui import ui

from hasel_workbench.cards import Card
from hasel_workbench.page.html import card_text, sliders_list
from hasel_workbench.sliders import sliders

_BEYOND = (
    '<p id="wb-beyond" role="status" hidden>Beyond first order: the errors foretold above mislead here. The curve is '
    "the true simulation of this run; let go to simulate all runs.</p>"
)


class EffectsPanel:
    """Drawn again when the session changes."""

    def __init__(self, page: Any) -> None:
        self._page = page
        with ui.element("section").classes("wb-card wb-of-runs wb-order-2").props('aria-label="values"'):
            ui.html("<h2>Values</h2>", sanitize=False)
            ui.html("<p>Drag: the curve follows at once, the true simulation behind it.</p>", sanitize=False)
            ui.html(_BEYOND, sanitize=False)
            self._values()
        with ui.element("section").classes("wb-card wb-of-runs wb-order-3").props('aria-label="effects"'):
            ui.html("<h2>Effects</h2>", sanitize=False)
            self._effects()

    def refresh(self) -> None:
        """Draw it again."""
        self._values.refresh()
        self._effects.refresh()

    @ui.refreshable_method
    def _values(self) -> None:
        state = self._page.session.state
        if state.steps:
            ui.html(sliders_list(sliders(state.shown.model)), sanitize=False)

    @ui.refreshable_method
    def _effects(self) -> None:
        state = self._page.session.state
        if not state.steps:
            return
        if state.diagnosis is None:
            ui.html("<p>Not ranked yet: diagnose, or try one by hand.</p>", sanitize=False)
        else:
            for group in state.diagnosis.groups_in_question[:3]:
                ui.label(f"These recordings cannot tell apart: {', '.join(group)}.")
        with ui.element("div").classes("wb-effects"):
            for card in self._page.session.cards():
                self._effect(card)

    def _effect(self, card: Card) -> None:
        page, session = self._page, self._page.session
        with ui.element("div").classes("wb-effect").props(f'data-effect="{card.effect}"'):
            with ui.element("div").classes("line"):
                ui.html(f"<b>{card.effect}</b>", sanitize=False)
                if card.on:
                    ui.html('<span class="chip on">on</span>', sanitize=False)
                if card.verdict:
                    css = card.verdict.replace(" ", "-")
                    ui.html(f'<span class="chip {css}">{card.verdict}</span>', sanitize=False)
                if card.probability is not None and card.probability > 0.005:
                    ui.html(
                        f'<span class="chip">probability {percent(card.probability)}</span>', sanitize=False
                    )
                ui.element("div").classes("grow")
                change = session.switch_off if card.on else session.switch_on
                word = "switch off" if card.on else "switch on"
                button = ui.button(
                    word,
                    on_click=lambda: page.do(
                        f"{word} {card.effect}", lambda progress: change(card.effect, progress)
                    ),
                )
                button.props(f'dense no-caps outline size=sm aria-label="{word} {card.effect}"')
                button.set_enabled(session.state.trial is None)
            ui.html(f"<p>{escape(card.physics)}</p>", sanitize=False)
            ui.html(
                f"<details><summary>{card.place}: equation, values, sources</summary>{card_text(card)}</details>",
                sanitize=False,
            )
