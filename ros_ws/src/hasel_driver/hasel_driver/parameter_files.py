"""Parameter files that do not reach the node: ROS would ignore them without a word, limits and all."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import yaml

from hasel_driver.errors import LimitError


def check_files(node_name: str, full_name: str, arguments: Sequence[str]) -> None:
    """Raises LimitError for a section of a parameter file that names this node in another namespace only.

    arguments: the process's command line.
    """
    for word, path in zip(arguments, arguments[1:], strict=False):
        if word != "--params-file":
            continue
        # No more than names and nesting is read, as launch_ros writes tags of Python: BaseLoader.
        sections = list(_sections(yaml.load(Path(path).read_text(), yaml.BaseLoader) or {}))
        meant = [name for name in sections if name.rpartition("/")[2] == node_name]
        if meant and full_name not in meant and not any("*" in name for name in sections):
            raise LimitError(
                f"{path} has parameters for {', '.join(meant)}, but this node is {full_name}, so they would be ignored:"
                f" write /**/{node_name} there."
            )


def _sections(tree: dict, above: str = "") -> Iterator[str]:
    """The full names of the nodes that a parameter file speaks of."""
    for key, content in tree.items():
        name = f"{above}/{str(key).strip('/')}"
        if isinstance(content, dict):
            if "ros__parameters" in content:
                yield name
            yield from _sections({k: v for k, v in content.items() if k != "ros__parameters"}, name)
