"""Where the executables begin: options are read before anything heavy is imported, so that --help answers at once.

`bench`, which imports nothing heavy, begins where it is.
"""

import sys
from importlib import import_module

from hasel_common.command_entry import command
from hasel_common.node_parameter import answer_help, user_arguments


@command
def demo() -> int:
    """`demo`: fit, diagnose, add, and watch the error fall."""
    return _run("demo")


@command
def live_demo() -> int:
    """`live_demo`: the whole rig without hardware."""
    return _run("live_demo")


@command
def lifecycle_manager() -> int:
    """`lifecycle_manager`, a node."""
    from hasel_bringup.lifecycle_manager.manager_parameters import PARAMETERS

    answer_help(
        "lifecycle_manager",
        "Brings the nodes up in order, and the driver down, grounded, when one of them ends "
        "(/hasel/lifecycle_manager/startup, /hasel/lifecycle_manager/shutdown).",
        [parameter.usage for parameter in PARAMETERS],
    )
    from hasel_bringup.lifecycle_manager.manager_node import main

    return main()


@command
def recorder() -> int:
    """`recorder`, a node."""
    from hasel_bringup.recorder.recorder_parameters import PARAMETERS

    answer_help(
        "recorder",
        "Records what is said about a run into one MCAP file, from the service /hasel/recorder/start to "
        "/hasel/recorder/stop.",
        [parameter.usage for parameter in PARAMETERS],
    )
    from hasel_bringup.recorder.recorder_node import main

    return main()


@command
def replay() -> int:
    """`replay RECORDING…`: onto the topics."""
    return _run("replay")


@command
def soak() -> int:
    """`soak`: the virtual rig for long, each node killed once."""
    return _run("soak")


@command
def virtual_camera() -> int:
    """`virtual_camera`, a node."""
    from hasel_bringup.virtual_camera.camera_parameters import PARAMETERS

    answer_help(
        "virtual_camera",
        "Draws a swimmer with a secret, moved by the supply's state (/hasel/state), as a camera sees it "
        "(/hasel/camera/image/compressed).",
        [parameter.usage for parameter in PARAMETERS],
    )
    from hasel_bringup.virtual_camera.camera_node import main

    return main()


@command
def virtual_rig() -> int:
    """`virtual_rig`: a node, with supply and driver beside it."""
    return _run("virtual_rig")


def _run(command: str) -> int:
    options = (
        import_module(f"hasel_bringup.{command}.options").parser().parse_args(user_arguments(sys.argv[1:]))
    )
    return import_module(f"hasel_bringup.{command}.command").run(options)
