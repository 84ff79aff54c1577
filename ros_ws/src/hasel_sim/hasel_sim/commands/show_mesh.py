"""`show_mesh`: draw a model's body, its regions and markers to a picture."""

import argparse
import sys
from pathlib import Path

from hasel_sim.errors import HaselSimError
from hasel_sim.mesh_picture import draw_angle, draw_mesh, save_picture
from hasel_sim.model import load_model


def run(options: argparse.Namespace) -> int:
    """Write the picture; 0, or 1 with a sentence about what is wrong."""
    try:
        model = load_model(options.model)
        if options.density is not None:
            model = model.with_numerics(mesh_density=options.density)
        path = options.output or Path(f"{model.name}_mesh.png")
        save_picture(draw_mesh(model) if options.bent is None else draw_angle(model, options.bent), path)
    except HaselSimError as error:
        print(f"show_mesh: {error}", file=sys.stderr)
        return 1
    print(f"Drew {path}.")
    return 0
