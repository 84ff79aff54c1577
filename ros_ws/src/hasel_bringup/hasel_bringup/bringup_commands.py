# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Where the executables begin: options are read before anything heavy is imported, so that --help answers at once.

`bench`, which imports nothing heavy, begins where it is.
"""

import argparse
import math
import sys
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path

from hasel_common.command_entry import command, in_a_sentence
from hasel_common.node_parameter import NodeParameter, answer_help, parameter_list, user_arguments

from hasel_bringup.bringup_parameters import LIFECYCLE_MANAGER, RECORDER, VIRTUAL_BODY, VIRTUAL_CAMERA
from hasel_bringup.errors import BringupError
from hasel_bringup.hidden_truth.hidden import MEANING, RANDOM, check_hidden


@command
def demo() -> int:
    """`demo`: fit, diagnose, add, and watch the error fall."""
    options = argparse.ArgumentParser(
        prog="demo",
        description="Fit, compare, watch it live, learn what is missing, add it, watch the error fall.",
    )
    data = Path("data") / "unseen_rig" / "quadratic_drag"
    _folder(options, "--data", data, "fit_*.csv and val_*.csv (default: %(default)s)")
    options.add_argument(
        "--body",
        type=Path,
        action="append",
        default=[],
        metavar="DIR",
        help="also the measured bodies in this folder: beam, loaded beam, arm (may be given several times)",
    )
    clone = "in this clone of the public repository"
    _folder(options, "--muscle", None, f"also the measured muscle {clone} MadhavL/PH-HASEL-Python")
    _folder(options, "--fish", None, f"also the filmed fish {clone} srl-ethz/fishsim")
    _folder(options, "--output", Path("output") / "demo", "(default: %(default)s)")
    return _run(options, "demonstrations.demo")


@command
def live_demo() -> int:
    """`live_demo`: the whole rig without hardware."""
    options = argparse.ArgumentParser(
        prog="live_demo",
        description="Virtual supply, driver, camera, tracker, simulator, identification and recorder as nodes: "
        "measure, learn what the model misses, add it to the running simulator, and open the secret.",
    )
    meaning = f"{MEANING} (default: %(default)s)"
    options.add_argument("--hidden", default=RANDOM, type=_hidden, metavar="A,B", help=meaning)
    options.add_argument("--seed", type=int, default=-1, help="of what is random; -1: another one each time")
    _folder(options, "--output", Path("output") / "live_demo", "(default: %(default)s)")
    options.add_argument(
        "--runs", type=int, metavar="N", help="only the N shortest runs, without learning anything from them"
    )
    options.add_argument(
        "--attach", action="store_true", help="use nodes that run already, as virtual.launch.py does"
    )
    return _run(options, "demonstrations.live_demo")


@command
def lifecycle_manager() -> int:
    """`lifecycle_manager`, a node."""
    return _run_node(
        "lifecycle_manager",
        "Brings the nodes up in order, and the driver down, grounded, when one of them ends "
        "(/hasel/lifecycle_manager/startup, /hasel/lifecycle_manager/shutdown).",
        LIFECYCLE_MANAGER,
        "lifecycle_manager",
    )


@command
def recorder() -> int:
    """`recorder`, a node."""
    return _run_node(
        "recorder",
        "Records what is said about a run into one MCAP file, from the service /hasel/recorder/start to "
        "/hasel/recorder/stop.",
        RECORDER,
        "recorder",
    )


@command
def replay() -> int:
    """`replay RECORDING…`: onto the topics."""
    options = argparse.ArgumentParser(
        prog="replay",
        description="Publish state and bending/measured from recordings, with their own stamps, in the namespace "
        "/hasel or another (--ros-args -r __ns:=/rig2); "
        "of further recordings: moved to follow 10 s after the one before.",
    )
    options.add_argument("recordings", nargs="+", metavar="RECORDING", help=".mcap or .csv file")
    options.add_argument("--rate", type=_rate, default=1.0, help="times real time, or max (default: 1)")
    options.add_argument(
        "--expect", nargs="*", default=[], metavar="NODE", help="nodes that must listen first"
    )
    options.add_argument(
        "--wait", type=float, default=30.0, help="longest wait for listeners [s] (default: 30)"
    )
    options.add_argument(
        "--clock", action="store_true", help="publish the stamps on /clock, for nodes with use_sim_time"
    )
    return _run(options, "replay")


@command
def soak() -> int:
    """`soak`: the virtual rig for long, each node killed once."""
    options = argparse.ArgumentParser(
        prog="soak",
        description="The virtual rig for ten minutes, each node killed and started again in the middle.",
    )
    options.add_argument("--minutes", type=float, default=10.0, help="(default: %(default)g)")
    _folder(options, "--output", Path("output") / "soak", "of the nodes' output (default: %(default)s)")
    return _run(options, "soak")


@command
def virtual_camera() -> int:
    """`virtual_camera`, a node."""
    return _run_node(
        "virtual_camera",
        "Draws a swimmer with a secret, moved by the supply's state (/hasel/state), as a camera sees it "
        "(/hasel/camera/image/compressed).",
        VIRTUAL_CAMERA,
        "virtual.virtual_camera",
    )


@command
def virtual_rig() -> int:
    """`virtual_rig`: a node, with supply and driver beside it."""
    options = argparse.ArgumentParser(
        prog="virtual_rig",
        description="A virtual supply with its driver (services arm …, action run_experiment), and a "
        "simulated swimmer before a noisy camera. Hide an effect with "
        "--ros-args -p 'hidden:=[quadratic_drag.coefficient=0.25]'.",
        epilog=parameter_list(parameter.usage for parameter in VIRTUAL_BODY),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    options.add_argument(
        "--body-only", action="store_true", help="without supply and driver: the topic state is given"
    )
    return _run(options, "virtual.virtual_rig")


def _run(options: argparse.ArgumentParser, module: str) -> int:
    """Call a module's `run` with the options given; what it refuses is one sentence, and exit code 1."""
    given = options.parse_args(user_arguments(sys.argv[1:]))
    from hasel_recording import RecordingError
    from hasel_sysid.errors import SysidError

    run = import_module(f"hasel_bringup.{module}").run
    return in_a_sentence(lambda: run(given), (BringupError, RecordingError, SysidError), 1)


def _run_node(name: str, description: str, parameters: Sequence[NodeParameter], module: str) -> int:
    answer_help(name, description, [parameter.usage for parameter in parameters])
    return import_module(f"hasel_bringup.{module}").main()


def _folder(options: argparse.ArgumentParser, name: str, default: Path | None, meaning: str) -> None:
    options.add_argument(name, type=Path, default=default, metavar="DIR", help=meaning)


def _hidden(text: str) -> str:
    try:
        check_hidden(text.split(","))
    except BringupError as error:
        raise argparse.ArgumentTypeError(str(error)) from error
    return text


def _rate(text: str) -> float:
    if text == "max":
        return math.inf
    try:
        rate = float(text)
    except ValueError:
        rate = 0.0
    if not 0 < rate < math.inf:
        raise argparse.ArgumentTypeError(f"'{text}' is no rate; expected a number above 0 such as 1, or max")
    return rate
