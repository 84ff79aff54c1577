# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A run that cannot be simulated: one sentence with its name, and the rest goes on."""

import json

import numpy as np
import pytest
from hasel_recording import Recording, write_recording
from hasel_sysid.command_line import compare, diagnose, improve

TIME = np.arange(0.0, 0.6, 0.01)


@pytest.fixture
def recordings(tmp_path):
    """A beam that was let go, and one under so many times its load that no beam carries it."""
    paths = []
    for name, factor, size in (("free", "1.5", 0.02), ("crushed", "5000", 0.03)):
        header = {"model": "beam", "initial_state": "static_equilibrium", "initial_load_factor": factor}
        swing = size * np.exp(-2 * TIME) * np.cos(45 * TIME)
        paths.append(str(tmp_path / f"{name}.csv"))
        write_recording(Recording(name, TIME, swing, metadata=header), paths[-1])
    return paths


@pytest.mark.parametrize("command", [compare, diagnose, improve])
def test_the_others_are_gone_on_with(recordings, command, tmp_path, capsys):
    """The note tells which run and why; the answer is of the other one, and there is one."""
    known = tmp_path / "found.json"
    chosen = ["--effects", "payload"] if command is not compare else []
    given = [*recordings, *chosen, "--jobs", "1", "--output", str(tmp_path), "--json", str(known)]
    assert command.main(given) in (0, 3)
    assert "Skipped: crushed cannot be simulated: no static equilibrium" in capsys.readouterr().err
    assert "crushed" not in json.dumps(json.loads(known.read_text()).get("runs", []))


def test_where_none_is_left_the_sentence_names_the_run(recordings, tmp_path, capsys):
    """And the command fails."""
    assert compare.main([recordings[1], "--jobs", "1", "--output", str(tmp_path)]) == 2
    assert "crushed cannot be simulated: no static equilibrium" in capsys.readouterr().err
