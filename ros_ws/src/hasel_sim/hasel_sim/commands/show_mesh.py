"""`show_mesh`: draw a model's body, its regions and markers to a picture."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from hasel_sim.errors import HaselSimError
from hasel_sim.mesh_picture import draw_mesh, save_picture
from hasel_sim.model import load_model


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the picture; 0, or 1 with a sentence about what is wrong."""
    parser = argparse.ArgumentParser(prog="show_mesh", description=__doc__)
    parser.add_argument(
        "model", nargs="?", default="swimmer", help="name or file of a model (default: swimmer)"
    )
    parser.add_argument(
        "--output", type=Path, metavar="FILE", help="PNG, SVG or PDF (default: MODEL_mesh.png)"
    )
    parser.add_argument("--density", type=float, metavar="D", help="mesh density, instead of the model's")
    options = parser.parse_args(arguments)
    try:
        model = load_model(options.model)
        if options.density is not None:
            model = model.with_numerics(mesh_density=options.density)
        path = options.output or Path(f"{model.name}_mesh.png")
        save_picture(draw_mesh(model), path)
    except HaselSimError as error:
        print(f"show_mesh: {error}", file=sys.stderr)
        return 1
    print(f"Drew {path}.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
