# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Where `driver_node`, `bench` and `console` begin: --help is answered before anything else is imported."""

import argparse
import signal
import sys
from collections.abc import Sequence
from pathlib import Path

from hasel_common.command_entry import command
from hasel_common.node_parameter import answer_help, user_arguments

from hasel_driver.nodes.parameters import PARAMETERS

DESCRIPTION = """`ros2 run hasel_driver console`: arm, ramp, hold and stop by hand, with the voltages shown live.

While a voltage is on, ANY KEY STOPS: the output is grounded and the driver is in FAULT."""
HELP = """  arm                    STANDBY to ARMED
  ramp UPPER LOWER [S]   to these voltages [V], hold for S seconds (default: until a key stops), and back to 0
  rate V                 ramp by V volts a second (1000 at first)
  limit V                lower the driver's maximum voltage
  disarm                 to STANDBY, grounded
  stop                   emergency stop
  release                take back what the emergency stop's topic holds
  clear                  FAULT to STANDBY
  state                  what the supply is doing
  quit                   disarm and leave"""


def bench_options(arguments: Sequence[str] | None = None) -> argparse.Namespace:
    """What the command line says; leaves with exit code 2 where it cannot be done."""
    parser = argparse.ArgumentParser(
        prog="bench",
        description="How fast a command reaches the wire, how fast a dead node is grounded, and how many experiments"
        " end by a fault although nothing is wrong but that the machine is busy.",
    )
    parser.add_argument("--commands", type=int, default=1000, help="commands for the latency")
    parser.add_argument("--kills", type=int, default=5, help="nodes to be killed")
    parser.add_argument("--experiments", type=int, default=0, help="of three seconds each, to be counted")
    parser.add_argument("--realtime-priority", type=int, default=40, help="the node's parameter; 0: none")
    parser.add_argument(
        "--firmware",
        type=Path,
        metavar="BUILD",
        help="folder in which `make -C firmware all simulator` built sketch and simulator: measure these, end to end,"
        " with the serial line's own speed, instead of the virtual supply",
    )
    options = parser.parse_args(arguments)
    build = options.firmware
    if build and not all((build / file).is_file() for file in ("simulate", "hasel_supply.elf")):
        parser.error(f"{options.firmware} holds no simulate and hasel_supply.elf: build them with make first")
    return options


def console_parser() -> argparse.ArgumentParser:
    """The command's options."""
    options = argparse.ArgumentParser(
        prog="console",
        description=DESCRIPTION,
        epilog=HELP,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    options.add_argument("--namespace", default="/hasel", help="of the driver (default: /hasel)")
    return options


@command
def bench(arguments: Sequence[str] | None = None) -> int:
    """Run the benchmark; returns the exit code."""
    options = bench_options(arguments)
    from hasel_driver.tools.driver_bench import run

    return run(options)


@command
def console() -> int:
    """Run the console until it is left; returns the exit code."""
    options = console_parser().parse_args(user_arguments(sys.argv[1:]))
    from hasel_driver.tools.console import run

    return run(options.namespace, HELP)


@command
def driver_node() -> int:
    """Run the node until it is shut down; returns the exit code."""
    answer_help(
        "driver_node",
        "Drives the high-voltage supply at a serial port: opens the port when it starts, arms nothing by itself.",
        [each.usage for each in PARAMETERS],
    )
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_DFL)  # until the node takes them over, nothing must be grounded
    from hasel_driver.nodes.driver_node import main as run

    return run()
