# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The README against the code: what it names exists, and what exists is named."""

import re
from pathlib import Path

import pytest
from hasel_common.topics import TOPIC_TYPES
from hasel_sim.effects.registry import catalogue
from hasel_sim.live.simulator_node import PARAMETERS as SIMULATOR
from hasel_sysid.live.sysid_node import PARAMETERS as SYSID

ROOT = Path(__file__).resolve().parents[2]
PAGES = [
    ROOT / "README.md",
    *sorted((ROOT / "docs").rglob("*.md")),
    *sorted((ROOT / "ros_ws" / "src").glob("*/README.md")),
]
POLICY = ROOT / "ros_ws" / "src" / "hasel_driver" / "security" / "policy.xml"
LIVE = (ROOT / "docs" / "how_to" / "live_rig.md").read_text(encoding="utf-8")
ENCLAVES = set(re.findall(r'path="(/hasel/\w+)"', POLICY.read_text(encoding="utf-8")))
SOURCES = "\n".join(
    path.read_text(encoding="utf-8")
    for path in sorted((ROOT / "ros_ws" / "src").rglob("*.py"))
    if "test" not in path.relative_to(ROOT / "ros_ws" / "src").parts
)


@pytest.mark.parametrize("node, table", [("simulator", SIMULATOR), ("sysid", SYSID)])
def test_parameters_are_those_of_the_nodes(node, table):
    """Every parameter has its row with default, unit and meaning, and no row is about another."""
    rows = re.findall(rf"^\| {node} \| `(\w+)` \| (\S+) \| (\S*) ?\| (.*) \|$", LIVE, flags=re.M)
    expected = [
        (p.name, "none" if p.default == [""] else f"`{p.default}`", p.unit or "", p.description)
        for p in table
    ]
    assert rows == expected


def test_the_readme_is_a_page():
    """What it is, two commands, the steps: everything else is in the documentation."""
    assert PAGES[0].stat().st_size <= 8000


def test_every_page_is_reached_from_the_readme():
    """By a link of its own, or of a page that has one."""
    reached, todo = set(), [PAGES[0]]
    while todo:
        page = todo.pop()
        if page.suffix == ".md" and page not in reached:
            reached.add(page)
            todo += [(page.parent / link).resolve() for link in _links(page)]
    assert set(PAGES) <= reached


def test_every_page_is_in_the_sites_table_of_contents():
    """And every entry there is a page."""
    contents = (ROOT / "mkdocs.yml").read_text(encoding="utf-8").split("\nnav:\n")[1]
    listed = re.findall(r"(\S+\.md)$", contents, flags=re.M)
    assert sorted(listed) == sorted(str(p.relative_to(ROOT / "docs")) for p in (ROOT / "docs").rglob("*.md"))


def test_package_readmes_are_short():
    """Each says what the package is and where its pages are."""
    for page in (ROOT / "ros_ws" / "src").glob("*/README.md"):
        assert page.stat().st_size <= 4000, page


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_topics_and_services_exist(page):
    """Every /hasel/… name of a page is a topic, or relative to the namespace a name in the code."""
    named = set(re.findall(r"`(/hasel/[a-z_/]+)`", page.read_text(encoding="utf-8")))
    for name in sorted(named - set(TOPIC_TYPES) - ENCLAVES):
        assert f'"{name.removeprefix("/hasel/")}"' in SOURCES, name


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_executables_exist(page):
    """Every `ros2 run` and `bin/ros2-run` line names an executable that a package installs."""
    lines = re.findall(r"(?:ros2 run|ros2-run) (hasel_\w+) ([a-z]\w*)", page.read_text(encoding="utf-8"))
    for package, executable in lines:
        setup = (ROOT / "ros_ws" / "src" / package / "setup.py").read_text(encoding="utf-8")
        assert f'"{executable} = ' in setup, (package, executable)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_somewhere(page):
    """Every relative link and picture is a file of the repository."""
    for target in _links(page):
        assert (page.parent / target).exists(), target


def _links(page: Path) -> list[str]:
    return re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8"))


def test_figures_of_hidden_effects_are_the_benchmarks():
    """Every row of the table stands in the page that the benchmark wrote."""
    page = (ROOT / "docs" / "results" / "hidden_effects_fresh.md").read_text(encoding="utf-8").splitlines()
    results = (ROOT / "docs" / "results" / "index.md").read_text(encoding="utf-8")
    section = results.split("## Is the right effect named?")[1].split("\n## ")[0]
    assert "(hidden_effects_fresh.md)" in section
    rows = [line for line in section.splitlines() if line.startswith("| ")]
    assert len(rows) > 5
    assert [row for row in rows if row not in page] == []


DATA = ROOT / "data"
DATA_README = (DATA / "README.md").read_text(encoding="utf-8")


def test_every_folder_of_recordings_is_described():
    """With what is hidden in it and at which value, as the tests know it."""
    rows = dict(re.findall(r"^\| `(unseen_rig/\w+)` \| .* \| (.*) \|$", DATA_README, flags=re.M))
    assert sorted(rows) == sorted(str(path.relative_to(DATA)) for path in DATA.glob("*/*") if path.is_dir())
    for folder, value in rows.items():
        for name in re.findall(r"`(\w+)`", value):
            effect = catalogue()[Path(folder).name]
            assert name in {parameter.name for parameter in effect.parameters}


def test_every_recording_is_as_described():
    """The columns of the table, voltages and frequencies of the file names, two periods at 120 frames per second."""
    columns = re.findall(r"^\| `(\w+)` \| \w+ \|", DATA_README, flags=re.M)
    for path in sorted(DATA.rglob("*.csv")):
        rows = path.read_text(encoding="utf-8").splitlines()
        assert rows[0].split(",") == columns, path
        voltage, frequency = map(float, re.fullmatch(r"\w+_(\d+)V_([\d.]+)Hz", path.stem).groups())
        use, kilovolts, hertz = next(
            row for row in re.findall(r"^\| `(\w+)_\*` \| (.*) kV \| (.*) Hz, two", DATA_README, flags=re.M)
            if path.name.startswith(row[0])
        )  # fmt: skip
        assert f"{voltage / 1000:g}" in kilovolts.split(", "), (use, path)
        assert f"{frequency:.1f}" in hertz.split(", "), (use, path)
        values = [[float(cell) for cell in row.split(",")] for row in rows[1:]]
        assert max(row[1] for row in values) == max(row[2] for row in values) == voltage
        assert values[-1][0] == pytest.approx(2 / frequency, abs=1 / 120)
        assert len(values) == pytest.approx(120 * 2 / frequency + 1, abs=1)
