# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`add EFFECT…` and `remove EFFECT…`: write the model with, or without, an effect."""

import argparse
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from hasel_sim.effects.registry import catalogue
from hasel_sim.model import Model, load_model, save_model

from hasel_sysid.command_line.options import add_parser, remove_parser
from hasel_sysid.command_line.running import told
from hasel_sysid.errors import SysidError


def add_main(arguments: Sequence[str] | None = None) -> int:
    """Run `add`; returns its exit code."""
    return run_add(add_parser().parse_args(arguments))


def remove_main(arguments: Sequence[str] | None = None) -> int:
    """Run `remove`; returns its exit code."""
    return run_remove(remove_parser().parse_args(arguments))


@told
def run_add(options: argparse.Namespace) -> None:
    """Run `add` with these options."""
    _change(options, "+", lambda model, effects: model.with_effects(*effects))


@told
def run_remove(options: argparse.Namespace) -> None:
    """Run `remove` with these options."""
    _change(options, "-", lambda model, effects: model.without_effects(*effects))


def _change(chosen: argparse.Namespace, joint: str, change: Callable[[Model, Sequence[str]], Model]) -> None:
    if chosen.list:
        for effect in catalogue().values():
            print(f"{effect.id:20} {effect.place:12} {effect.physics}")
        return
    if not chosen.effects:
        raise SysidError("no effect was named; expected at least one: name one, or give --list to see them")
    changed = change(load_model(chosen.model), chosen.effects)
    path = chosen.output
    if path.suffix not in (".yaml", ".yml"):
        names = [effect.rpartition(":")[2] for effect in chosen.effects]
        path = path / (Path(chosen.model).stem + "".join(joint + name for name in names) + ".yaml")
    path.parent.mkdir(parents=True, exist_ok=True)
    save_model(changed, path)
    kept = ", ".join(effect.id for effect in changed.effects) or "no effects"
    print(f"Wrote {path} with {kept}; fit it with: fit --model {path} RECORDING…")


if __name__ == "__main__":
    sys.exit(add_main())
