# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The command `suggest` from end to end, on a coarse model with a hidden effect."""

import json

from hasel_common.yaml_text import read_yaml
from hasel_sysid.command_line import suggest


def test_two_named_effects_are_compared_though_one_explains_all(with_drag, tmp_path, capsys):
    """The run that would tell them apart best is printed, and written as a goal within the safe maximum."""
    written = ["--output", str(tmp_path), "--json", str(tmp_path / "s.json"), "--max-voltage", "5000"]
    assert suggest.main([*with_drag.arguments("muscle_asymmetry"), *written]) == 0
    content = json.loads((tmp_path / "s.json").read_text())
    assert [pair["effects"] for pair in content["pairs"]] == [["muscle_asymmetry", "quadratic_drag"]]
    assert content["difference"] > 1.0
    goal = read_yaml((tmp_path / "suggested_run.yaml").read_text())
    assert goal == content["run"]
    assert goal["voltage"] <= 5000.0
    assert "muscle_asymmetry, quadratic_drag would differ by" in capsys.readouterr().out
