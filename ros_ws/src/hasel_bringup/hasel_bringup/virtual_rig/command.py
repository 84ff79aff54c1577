"""`ros2 run hasel_bringup virtual_rig`: supply, swimmer and camera without hardware, on the topics of the real ones."""

import argparse
import contextlib
import sys

import rclpy
from hasel_sim.errors import HaselSimError
from rclpy.exceptions import InvalidParameterValueException
from rclpy.executors import ExternalShutdownException
from rclpy.utilities import remove_ros_args
from threadpoolctl import threadpool_limits

from hasel_bringup.errors import BringupError
from hasel_bringup.virtual_rig.body_node import VirtualBodyNode
from hasel_bringup.virtual_rig.virtual_supply import VirtualSupply


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="virtual_rig",
        description="A virtual supply with its driver (services /hasel/arm …, action /hasel/run_experiment), and a "
        "simulated swimmer before a noisy camera. Hide an effect with "
        "--ros-args -p 'hidden:=[quadratic_drag.coefficient=0.25]'.",
    )
    parser.add_argument(
        "--body-only", action="store_true", help="without supply and driver: /hasel/state is given"
    )
    return parser


def main() -> int:
    """Run until interrupted; returns the exit code."""
    arguments = _parser().parse_args(remove_ros_args(sys.argv)[1:])
    rclpy.init()
    node = None
    try:
        with (
            threadpool_limits(1),
            contextlib.nullcontext() if arguments.body_only else VirtualSupply() as supply,
        ):
            node = VirtualBodyNode()
            if supply is not None:
                node.create_timer(1.0, supply.check)
            rclpy.spin(node)
    except (HaselSimError, BringupError, InvalidParameterValueException) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
