"""`ros2 run hasel_bringup virtual_rig`: supply, swimmer and camera without hardware, on the topics of the real ones."""

import argparse
import contextlib

from hasel_sim.errors import HaselSimError
from hasel_sim.node_process import run_node
from threadpoolctl import threadpool_limits

from hasel_bringup.errors import BringupError
from hasel_bringup.virtual_rig.body_node import VirtualBodyNode
from hasel_bringup.virtual_rig.virtual_supply import RigSupply


def run(options: argparse.Namespace) -> int:
    """Run until interrupted; returns the exit code."""
    with threadpool_limits(1), contextlib.ExitStack() as stack:
        return run_node(lambda: _node(options, stack), errors=(HaselSimError, BringupError))


def _node(options: argparse.Namespace, stack: contextlib.ExitStack) -> VirtualBodyNode:
    """The body's node and, for as long as `stack` is open, a virtual supply that it watches."""
    node = VirtualBodyNode()
    if not options.body_only:
        supply = stack.enter_context(RigSupply(node.get_namespace()))
        node.create_timer(1.0, supply.check)
    return node
