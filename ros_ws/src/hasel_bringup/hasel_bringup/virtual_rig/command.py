"""`ros2 run hasel_bringup virtual_rig`: supply, swimmer and camera without hardware, on the topics of the real ones."""

import argparse
import contextlib
import sys

from hasel_sim.errors import HaselSimError
from hasel_sim.node_process import run_node
from rclpy.utilities import remove_ros_args
from threadpoolctl import threadpool_limits

from hasel_bringup.errors import BringupError
from hasel_bringup.virtual_rig.body_node import VirtualBodyNode
from hasel_bringup.virtual_rig.virtual_supply import VirtualSupply


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="virtual_rig",
        description="A virtual supply with its driver (services arm …, action run_experiment), and a "
        "simulated swimmer before a noisy camera. Hide an effect with "
        "--ros-args -p 'hidden:=[quadratic_drag.coefficient=0.25]'.",
    )
    parser.add_argument(
        "--body-only", action="store_true", help="without supply and driver: the topic state is given"
    )
    return parser


def main() -> int:
    """Run until interrupted; returns the exit code."""
    arguments = _parser().parse_args(remove_ros_args(sys.argv)[1:])
    with threadpool_limits(1), contextlib.ExitStack() as stack:
        return run_node(lambda: _node(arguments, stack), errors=(HaselSimError, BringupError))


def _node(arguments: argparse.Namespace, stack: contextlib.ExitStack) -> VirtualBodyNode:
    """The body's node and, for as long as `stack` is open, a virtual supply that it watches."""
    node = VirtualBodyNode()
    if not arguments.body_only:
        supply = stack.enter_context(VirtualSupply(node.get_namespace()))
        node.create_timer(1.0, supply.check)
    return node


if __name__ == "__main__":
    sys.exit(main())
