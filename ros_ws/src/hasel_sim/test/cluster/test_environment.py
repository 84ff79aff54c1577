# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What a process says about its sources and libraries."""

import sys

from hasel_sim.cluster import difference
from hasel_sim.cluster_environment import LIBRARIES, MISSING, environment


def test_a_changed_source_is_another_environment(tmp_path, monkeypatch):
    """Though the version is the same; a process that has begun stays what it was."""
    folder = tmp_path / "laboratory"
    folder.mkdir()
    (folder / "__init__.py").write_text("LENGTH = 1.0")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "hasel_sources_read", {}, raising=False)
    before = environment(("laboratory",))
    assert before["laboratory"].startswith("missing (sources ")
    (folder / "__init__.py").write_text("LENGTH = 2.0")
    assert environment(("laboratory",)) == before
    monkeypatch.setattr(sys, "hasel_sources_read", {})
    assert difference(before, environment(("laboratory",))).startswith("has laboratory missing (sources ")


def test_what_is_not_there_is_said():
    """A package that nobody has, and every library by its release."""
    found = environment(("hasel_nothing",))
    assert found["hasel_nothing"] == MISSING
    assert set(found) == {"hasel_nothing", *LIBRARIES}
    assert all(found[library].count(".") == 1 for library in LIBRARIES)


def test_found_and_expected_are_named():
    """What is the same is not."""
    own = {"hasel_sim": "0.2.0 (sources 1)", "numpy": "2.1", "numba": "0.61"}
    assert difference(own, dict(own)) is None
    assert difference(own, own | {"numba": "0.60"}) == "has numba 0.60; expected numba 0.61"
    assert difference(own, {"numpy": "2.1", "numba": MISSING}) == (
        "lacks hasel_sim, numba; expected hasel_sim 0.2.0 (sources 1)"
    )
