"""Files that a request names, which may come from any node of the network: those of one folder only."""

from pathlib import Path

from hasel_common.inside_folder import inside_folder

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
    try:
        return f"{inside_folder(folder, path)}{colon}{kind}"
    except ValueError as error:
        raise ModelError(f"{error}: name one there; the folder was given as own_files") from None
