"""Where an experiment is recorded: never where something exists already."""

import itertools
from datetime import datetime
from pathlib import Path

from hasel_common.inside_folder import inside_folder

from hasel_driver.errors import LimitError

SUFFIX = ".mcap"


def below(folder: Path, given: str, what: str) -> Path:
    """The path that a goal names, which may come from anywhere: inside `folder` only. Raises LimitError."""
    try:
        return inside_folder(folder, given)
    except ValueError as error:
        raise LimitError(
            f"{what}: {error}: name one there, or start the node with another folder."
        ) from error


def chosen_path(folder: Path, output: str) -> Path:
    """The path that a goal names, with its suffix. Raises LimitError for a name that is no file inside `folder`."""
    path = below(folder, output, "output")
    return path if path.suffix == SUFFIX else path.with_name(path.name + SUFFIX)


def reserve(path: Path) -> Path:
    """Create `path`, empty, and return it. Raises LimitError where it exists, OSError where it cannot be made."""
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        path.open("xb").close()
    except FileExistsError as error:
        raise LimitError(
            f"{path} exists already, and no recording is overwritten: choose another output, or leave it empty."
        ) from error
    return path


def reserve_unique(folder: Path, name: str) -> Path:
    """A file in `folder` named by the time to the millisecond and `name`, numbered where that is taken."""
    moment = datetime.now().strftime("%Y-%m-%d_%H-%M-%S-%f")[:-3]
    numbered = (f"{moment}_{name}_{number}{SUFFIX}" for number in itertools.count(2))
    path = folder / f"{moment}_{name}{SUFFIX}"
    while True:
        try:
            return reserve(path)
        except LimitError:
            path = folder / next(numbered)
