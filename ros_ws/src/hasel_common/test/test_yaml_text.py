# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""YAML 1.2 with PyYAML."""

import pytest
from hasel_common.yaml_text import YAMLError, read_yaml, yaml_text


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e-3", 1e-3),
        ("-1.5E5", -1.5e5),
        (".5", 0.5),
        ("1_000", 1000),
        ("017", 17),
        ("0o17", 15),
        ("0x1F", 31),
        ("-.inf", -float("inf")),
        ("1:30", "1:30"),
        ("on", "on"),
        ("yes", "yes"),
        ("True", True),
        ("~", None),
    ],
)
def test_a_scalar_is_what_yaml_1_2_says(text, value):
    """Not what 1.1 says, which takes 1e-3 for a word, 1:30 for 90 and on for true."""
    found = read_yaml(f"a: {text}")["a"]
    assert (found, type(found)) == (value, type(value))


def test_a_key_that_is_there_twice_is_told_with_its_line():
    """As any other fault is."""
    with pytest.raises(
        YAMLError, match=r'(?s)duplicate key "a" with value "2" \(original value: "1"\).*line 2'
    ):
        read_yaml("a: 1\na: 2\n")
    with pytest.raises(YAMLError, match="line 1, column 4"):
        read_yaml("a: [1, 2\nb: 3\n")


def test_what_is_written_is_read_back_by_either_version():
    """Numbers are numbers and words are words, in their order."""
    yaml = pytest.importorskip("yaml")
    content = {"z": 1e-8, "words": ["on", "1e3", "0o17", "1:30", "θ"], "a": {"b": [1.5, None, True]}}
    assert list(read_yaml(yaml_text(content))) == list(content)
    assert read_yaml(yaml_text(content)) == content == yaml.safe_load(yaml_text(content))
