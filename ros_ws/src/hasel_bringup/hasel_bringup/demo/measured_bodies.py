"""Recordings of real bodies that the demo treats when it is given their folder."""

from dataclasses import dataclass
from pathlib import Path

from hasel_bringup.errors import BringupError


@dataclass(frozen=True)
class MeasuredBody:
    """name: of its results' folder; model: that it is compared with; fitted and unseen: files of the folder."""

    name: str
    model: str
    fitted: tuple[str, ...]
    unseen: tuple[str, ...]

    def files(self, folder: Path) -> tuple[list[Path], list[Path]] | None:
        """The fitted and the unseen files; None where the folder does not hold all of them."""
        fitted, unseen = ([folder / name for name in names] for names in (self.fitted, self.unseen))
        return (fitted, unseen) if all(path.is_file() for path in (*fitted, *unseen)) else None


MEASURED_BODIES = (
    MeasuredBody("beam", "beam", ("gravity_a.csv",), ("gravity_b.csv",)),
    MeasuredBody("loaded_beam", "beam", ("load52_a.csv",), ("load52_b.csv",)),
    MeasuredBody(
        "arm",
        "arm",
        tuple(f"step_{pressure}mbar.csv" for pressure in (100, 200, 300, 400)),
        ("step_250mbar.csv",),
    ),
)


def found_in(folders: list[Path]) -> list[tuple[MeasuredBody, list[Path], list[Path]]]:
    """Bodies whose recordings lie in the folders or in folders within them, with their fitted and unseen files.

    Raises BringupError for a folder that holds none.
    """
    found = []
    for folder in folders:
        places = [folder, *sorted(path for path in folder.glob("*") if path.is_dir())]
        here = [
            (body, *files) for place in places for body in MEASURED_BODIES if (files := body.files(place))
        ]
        if not here:
            known = "; ".join(", ".join((*body.fitted, *body.unseen)) for body in MEASURED_BODIES)
            raise BringupError(
                f"there is no measured body in {folder}; expected one of these sets of recordings: {known}"
            )
        found += here
    return found
