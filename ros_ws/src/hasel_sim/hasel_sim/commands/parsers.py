"""The options of every command, without anything that takes time to import."""

import argparse
from pathlib import Path


def bench_parser() -> argparse.ArgumentParser:
    """Options of `bench`."""
    options = argparse.ArgumentParser(prog="bench", description="Speed beside its bars, or convergence.")
    options.add_argument(
        "--convergence", action="store_true", help="errors under refinement instead of speed"
    )
    options.add_argument("--json", type=Path, metavar="FILE", help="write all numbers here")
    return options


def effects_parser() -> argparse.ArgumentParser:
    """Options of `effects`."""
    options = argparse.ArgumentParser(
        prog="effects", description="List the physical effects that a model can have, or print one's card."
    )
    options.add_argument(
        "names", nargs="*", metavar="NAME", help="an effect's id, or path/to/file.py:ClassName of your own"
    )
    options.add_argument("--table", action="store_true", help="print all of them as the documentation's page")
    return options


def show_mesh_parser() -> argparse.ArgumentParser:
    """Options of `show_mesh`."""
    options = argparse.ArgumentParser(
        prog="show_mesh", description="Draw a model's body, its regions and markers to a picture."
    )
    options.add_argument(
        "model", nargs="?", default="swimmer", help="name or file of a model (default: swimmer)"
    )
    options.add_argument(
        "--output", type=Path, metavar="FILE", help="PNG, SVG or PDF (default: MODEL_mesh.png)"
    )
    options.add_argument("--density", type=float, metavar="D", help="mesh density, instead of the model's")
    return options
