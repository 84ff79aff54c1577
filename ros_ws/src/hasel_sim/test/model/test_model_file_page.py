# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The page of the model file against what is read."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from hasel_sim.model import load_model
from hasel_sim.model.description import Description
from hasel_sim.model.sections import Section

PAGE = (Path(__file__).resolve().parents[5] / "docs" / "reference" / "model_file.md").read_text(
    encoding="utf-8"
)


def sections(kind: type[Section] = Section) -> Iterator[type[Section]]:
    """Every kind of section, however deep."""
    for each in kind.__subclasses__():
        of_a_muscle = each.__module__ == "hasel_sim.model.muscle_file"
        if each.__module__.startswith("hasel_sim.model.") and not of_a_muscle:
            yield each
            yield from sections(each)


@pytest.mark.parametrize("section", sorted(sections(), key=str), ids=lambda section: section.__name__)
def test_every_key_is_on_the_page(section):
    """By its name; `name` of the whole file is shown in the example."""
    assert Description in sections()
    assert [key for key in section.model_fields if f"`{key}`" not in PAGE] == []


def test_the_example_is_a_body(tmp_path):
    """It is read, and a pressure drives it."""
    (text,) = re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL)
    (tmp_path / "my_beam.yaml").write_text(text)
    assert (
        load_model(tmp_path / "my_beam.yaml").description.channels[0].column.column == "pressure_chamber_pa"
    )
