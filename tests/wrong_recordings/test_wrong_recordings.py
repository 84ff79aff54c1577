# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The page of what can be wrong with a recording says what the code says: every sentence, and all of them."""

import re
from pathlib import Path

import pytest

from tests.wrong_recordings import bags, pictures, runs, texts
from tests.wrong_recordings.said import faults, sentences, templates

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "ros_ws" / "src"
PAGE = (SOURCE.parents[1] / "docs" / "how_to" / "wrong_recordings.md").read_text(encoding="utf-8")
ROWS = re.findall(r"^\| (?!what is wrong)[^|]+ \| (`+)(.+?)\1 \| [^|]+ \|$", PAGE, flags=re.M)
QUOTED = [sentence for _, sentence in ROWS]


def _modules(package: str, *patterns: str) -> list[Path]:
    return sorted(path for each in patterns for path in (SOURCE / package / package).glob(each))


READERS = [
    *_modules(
        "hasel_recording", "bag.py", "csv_*.py", "drive_*.py", "mcap_*.py", "plateaus.py", "reading.py"
    ),
    *_modules("hasel_tracker", "sources/*.py", "offline/drive*.py"),
    *_modules("hasel_sysid", "dataset.py", "experiment.py"),
]
OTHERS = {
    "of writing": (
        "says neither MCAP nor CSV",
        "cannot be written",
        "does not fit on one CSV line",
        "is closed:",
    )
    + ("simulated angle was left out", "could not be finished", "holds {}, so no", "The type of topic"),
    "of a call in Python": ("gives its", "Skipped: ", "for the names of columns"),
    "how columns are understood": ("cells are separated by", "time is column", "sin θ ", "{} is column"),
}
"""Sentences of these modules that are not about a fault of a recording."""
COSTLY = (
    "cannot be read (…)",
    "its checksum does not fit",
    "its header is damaged",
    "The camera …",
    "There is no drive file",
    "The drive foretells nothing",
    "fit about equally well",
)
"""Quoted sentences whose inputs would cost more than they show: they stand in the code."""


@pytest.fixture(scope="module")
def said(tmp_path_factory) -> set[str]:
    """What is said of all made inputs."""
    found = sentences(runs.inputs(), Path("/nowhere"))
    for module in (texts, bags, pictures):
        folder = tmp_path_factory.mktemp(module.__name__.rpartition(".")[2])
        found |= sentences(module.inputs(folder), folder)
    return found


def _pattern(quoted: str) -> re.Pattern:
    return re.compile(re.escape(quoted).replace("…", ".+"))


def test_the_page_has_its_tables():
    """One for each place; every row of a table is read here."""
    assert re.findall("^## (.*)$", PAGE, flags=re.M) == [
        "File",
        "Columns",
        "Time",
        "Drive",
        "Angle and markers",
        "Picture",
    ]
    lines = [line for line in PAGE.splitlines() if line.startswith("|") and "---" not in line]
    assert len(lines) == len(ROWS) + 6


@pytest.mark.parametrize("quoted", [each for each in QUOTED if not any(part in each for part in COSTLY)])
def test_a_sentence_is_said(said, quoted):
    """A small faulty input makes the code say it."""
    assert any(map(_pattern(quoted).fullmatch, said))


@pytest.mark.parametrize("quoted", [each for each in QUOTED if any(part in each for part in COSTLY)])
def test_a_costly_sentence_stands_in_the_code(quoted):
    """Where the input would be costly, or a device."""
    assert any(pattern.search(quoted) for path in READERS for _, pattern in templates(path))


@pytest.mark.parametrize("path", READERS, ids=lambda path: path.stem)
def test_every_sentence_is_on_the_page(path):
    """No reader says what the page has not got."""
    for shown, pattern in templates(path):
        if not any(part in shown for parts in OTHERS.values() for part in parts):
            assert any(map(pattern.search, QUOTED)), shown


def test_every_fault_of_the_set_up_is_on_the_page():
    """Each name that `check` gives to a fault."""
    named = {
        each
        for path in (SOURCE / "hasel_sysid" / "hasel_sysid" / "data_quality").glob("*.py")
        for each in faults(path)
    }
    assert named <= {quoted.split(": ")[1] for quoted in QUOTED if quoted.startswith("run: ")}
