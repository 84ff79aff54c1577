"""The options of `virtual_rig`, without anything that takes time to import."""

import argparse

from hasel_common.node_parameter import parameter_list

from hasel_bringup.virtual_rig.body_parameters import PARAMETERS


def parser() -> argparse.ArgumentParser:
    """The command's options."""
    options = argparse.ArgumentParser(
        prog="virtual_rig",
        description="A virtual supply with its driver (services arm …, action run_experiment), and a "
        "simulated swimmer before a noisy camera. Hide an effect with "
        "--ros-args -p 'hidden:=[quadratic_drag.coefficient=0.25]'.",
        epilog=parameter_list(parameter.usage for parameter in PARAMETERS),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    options.add_argument(
        "--body-only", action="store_true", help="without supply and driver: the topic state is given"
    )
    return options
