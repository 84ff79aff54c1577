# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Where `workbench` begins: options are read before anything heavy is imported, so that --help answers at once."""

import argparse
from pathlib import Path

from hasel_common.command_entry import command
from hasel_sysid.command_line.options import recording_options, run_module


@command
def workbench() -> int:
    """`workbench [RECORDING…]`."""
    return run_module(workbench_parser, "hasel_workbench.command")


def workbench_parser() -> argparse.ArgumentParser:
    """Options of `workbench`."""
    what = (
        "Serve a page on which runs are loaded and compared, effects tried by hand, values dragged, and the error "
        "watched as it falls; on a running rig too."
    )
    options = recording_options("workbench", what, effects=True, recordings="*", json=False)
    options.set_defaults(output=Path("workbench"))
    add = options.add_argument
    add("--host", default="127.0.0.1", help="address to listen at (default: this machine only)")
    add("--port", type=int, default=8477, help="port; 0: any that is free (default: %(default)s)")
    add("--certificate", metavar="FILE", type=Path, help="serve HTTPS with this certificate")
    add("--key", metavar="FILE", type=Path, help="the certificate's key")
    add("--unencrypted", action="store_true", help="let others on the network in without a certificate")
    add("--no-browser", dest="browser", action="store_false", help="open no browser")
    add("--no-rig", dest="rig", action="store_false", help="do not listen to a running rig")
    add("--namespace", default="/hasel", help="of the rig (default: %(default)s)")
    add("--bench", action="store_true", help="measure in a browser how fast the page answers, and end")
    return options
