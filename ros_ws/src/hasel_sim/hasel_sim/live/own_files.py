"""Files that a request names, which may come from any node of the network: those of one folder only."""

from pathlib import Path

from hasel_sim.errors import ModelError


def within(folder: str, name: str) -> str:
    """`name` of a model or an effect, where it is no file or one below `folder`. Raises ModelError for any other."""
    path, colon, kind = name.partition(":")
    if not colon and not Path(name).suffix and "/" not in name:
        return name
    if not folder:
        raise ModelError(
            f"'{name}' is a file, and a request may name the catalogue's only: start the node with own_files set to the"
            " folder in which yours are"
        )
    root = Path(folder).expanduser().resolve()
    file = (root / Path(path)).resolve()
    if root not in file.parents:
        raise ModelError(
            f"'{name}' is not below {root}; expected a file there: it was given at the start as own_files"
        )
    return f"{file}{colon}{kind}"
