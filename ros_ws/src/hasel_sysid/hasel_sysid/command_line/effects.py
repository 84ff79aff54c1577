"""`add EFFECT…` and `remove EFFECT…`: write the model with, or without, an effect."""

import argparse
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from hasel_sim.effects.registry import catalogue
from hasel_sim.model import Model, load_model, save_model

from hasel_sysid.command_line.inputs import DEFAULT_MODEL
from hasel_sysid.command_line.running import run_command


def _parser(name: str, description: str, joint: str) -> argparse.ArgumentParser:
    options = argparse.ArgumentParser(prog=name, description=description)
    options.add_argument(
        "effects", metavar="EFFECT", nargs="*", help="id of an effect, or path/to/file.py:ClassName"
    )
    options.add_argument(
        "--model",
        metavar="NAME|FILE",
        default=DEFAULT_MODEL,
        help="model to start from (default: %(default)s)",
    )
    options.add_argument(
        "--output",
        metavar="DIR|FILE",
        type=Path,
        default=Path(),
        help=f"folder, or .yaml file to write (default: MODEL{joint}EFFECT.yaml here)",
    )
    options.add_argument("--list", action="store_true", help="list the effects there are")
    return options


def add_main(arguments: Sequence[str] | None = None) -> int:
    """Run `add`; returns its exit code."""
    options = _parser("add", "Write a model with further effects, at values at which they do nothing.", "+")
    return _run(options, arguments, "+", lambda model, effects: model.with_effects(*effects))


def remove_main(arguments: Sequence[str] | None = None) -> int:
    """Run `remove`; returns its exit code."""
    options = _parser("remove", "Write a model without some of its effects.", "-")
    return _run(options, arguments, "-", lambda model, effects: model.without_effects(*effects))


def _run(
    options: argparse.ArgumentParser,
    arguments: Sequence[str] | None,
    joint: str,
    change: Callable[[Model, Sequence[str]], Model],
) -> int:
    chosen = options.parse_args(arguments)
    if chosen.list:
        return run_command(_list)
    if not chosen.effects:
        options.error("name at least one effect, or --list")
    return run_command(lambda: _change(chosen, joint, change))


def _list() -> None:
    for effect in catalogue().values():
        print(f"{effect.id:20} {effect.place:12} {effect.physics}")


def _change(chosen: argparse.Namespace, joint: str, change: Callable[[Model, Sequence[str]], Model]) -> None:
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
