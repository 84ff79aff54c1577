# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""YAML 1.2 with PyYAML, which by itself speaks 1.1: 1e-3 is a number, on and yes are words, no key is given twice."""

import re
from typing import Any

import yaml

YAMLError = yaml.YAMLError
"""What `read_yaml` raises; its text says in which line and column."""

_FLOAT, _INT = "tag:yaml.org,2002:float", "tag:yaml.org,2002:int"
_AS_FLOAT = re.compile(
    r"[-+]?(?:[0-9][0-9_]*\.[0-9_]*|\.[0-9][0-9_]*)(?:[eE][-+]?[0-9]+)?$|[-+]?[0-9][0-9_]*[eE][-+]?[0-9]+$"
    r"|[-+]?\.(?:inf|Inf|INF)$|\.(?:nan|NaN|NAN)$"
)
_AS_INT = re.compile(r"[-+]?(?:0b[01_]+|0o?[0-7_]+|0x[0-9a-fA-F_]+|[0-9][0-9_]*)$")
_RESOLVERS = (
    ("tag:yaml.org,2002:bool", re.compile(r"(?:true|True|TRUE|false|False|FALSE)$"), "tTfF"),
    (_FLOAT, _AS_FLOAT, "-+.0123456789"),
    (_INT, _AS_INT, "-+0123456789"),
)


class _Reader(yaml.SafeLoader):
    """Scalars as in YAML 1.2."""

    yaml_implicit_resolvers = {  # noqa: RUF012  a table of the library
        first: [(tag, text) for tag, text in known if tag not in {each[0] for each in _RESOLVERS}]
        for first, known in yaml.SafeLoader.yaml_implicit_resolvers.items()
    }

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Any, Any]:
        """A dictionary. Raises ConstructorError for a key that is there twice."""
        known: dict[tuple[str, str], Any] = {}
        for key, value in node.value:
            name = (key.tag, str(key.value))
            if name in known:
                raise yaml.constructor.ConstructorError(
                    "while constructing a mapping",
                    node.start_mark,
                    f'found duplicate key "{key.value}" with value "{value.value}" '
                    f'(original value: "{known[name].value}")',
                    key.start_mark,
                )
            known[name] = value
        return super().construct_mapping(node, deep)

    def whole_number(self, node: yaml.ScalarNode) -> int:
        """With the base by its prefix; a leading zero alone is none."""
        text = self.construct_scalar(node).replace("_", "")
        return int(text, 0 if re.match("[-+]?0[box]", text) else 10)


class _Writer(yaml.SafeDumper):
    """Puts quotes about text that YAML 1.1 or 1.2 would take for something else."""


for _tag, _text, _first in _RESOLVERS:
    _Reader.add_implicit_resolver(_tag, _text, list(_first))
    _Writer.add_implicit_resolver(_tag, _text, list(_first))
_Reader.add_constructor(_INT, _Reader.whole_number)


def read_yaml(text: str) -> Any:
    """The one document in a text, of plain values. Raises YAMLError."""
    return yaml.load(text, _Reader)


def yaml_text(content: Any) -> str:
    """A document that `read_yaml` reads back, keys in their order, one value a line."""
    return yaml.dump(content, Dumper=_Writer, sort_keys=False, allow_unicode=True)
