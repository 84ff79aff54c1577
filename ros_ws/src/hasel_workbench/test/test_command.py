# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`workbench` where something it needs is not there."""

from hasel_workbench import command as workbench


def test_without_nicegui_it_says_what_to_install(monkeypatch, capsys):
    """One sentence, and an exit code."""
    monkeypatch.setattr(workbench, "find_spec", lambda name: None)
    assert workbench.main([]) != 0
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "pip install 'nicegui>=3,<4'" in said
