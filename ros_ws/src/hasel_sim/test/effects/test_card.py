# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Cards, the list of effects, and the documentation's page."""

from pathlib import Path

import pytest
from hasel_sim.commands.effects import document
from hasel_sim.commands.entry import effects as main
from hasel_sim.effects.registry import catalogue

DOCS = Path(__file__).parents[2] / "docs"
PAGES = Path(__file__).resolve().parents[5] / "docs"


def test_the_documentation_is_not_stale():
    """docs/reference/effects.md is what `effects --table` prints now."""
    assert (PAGES / "reference" / "effects.md").read_text() == document(catalogue().values())


def test_the_list_names_every_effect(capsys):
    """Without arguments the command prints one line per effect."""
    assert main([]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(catalogue())


@pytest.mark.parametrize("identity", sorted(catalogue()))
def test_a_card_states_everything(identity, capsys):
    """A card shows physics, equation, parameters with unit and range, signature, confusions and the experiment."""
    assert main([identity]) == 0
    shown, effect = capsys.readouterr().out, catalogue()[identity]
    parts = [
        identity,
        effect.physics,
        effect.equation,
        effect.signature,
        effect.separated_by,
        effect.citation,
    ]
    parts += [
        *effect.confused_with,
        *(p.source for p in effect.parameters),
        *(p.name for p in effect.parameters),
    ]
    assert not [part for part in parts if part not in shown]


def test_a_card_of_a_users_own_effect(capsys):
    """A path and class name work where an id does."""
    assert main([f"{DOCS}/examples/cross_talk.py:CrossTalk"]) == 0
    assert "coupling (c): null 0, plausible 0 to 0.8" in capsys.readouterr().out


def test_an_unknown_effect_is_one_sentence(capsys):
    """A misspelt id exits with an error that names the nearest one."""
    assert main(["quadratic_drga"]) == 1
    assert capsys.readouterr().err.startswith(
        "error: unknown effect 'quadratic_drga'; the nearest known one is"
    )
