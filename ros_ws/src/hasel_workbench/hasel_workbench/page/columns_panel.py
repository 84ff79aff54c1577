"""Which column is which, of files that could not be read for the names of their columns."""

from collections.abc import Mapping, Sequence
from typing import Any

from hasel_recording.csv_columns import THETA_UNITS, TIME_UNITS
from hasel_recording.drive_channel import UNITS
from hasel_sim.model import Model
from nicegui import ui

from hasel_workbench.state import Unread

_SINE, _NONE = "its sine", "–"


class ColumnsPanel:
    """A card for every such file; drawn again when the session changes."""

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
                ui.button("Read it so", on_click=read).props("dense no-caps unelevated")
                over = ui.button("Leave it out")
                over.on_click(lambda: page.at_once(lambda: session.pass_over(unread.path)))
                over.props("dense no-caps outline")


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
