"""The options of `workbench`, without anything that takes time to import."""

import argparse
from pathlib import Path

from hasel_sysid.command_line.options import recording_options


def workbench_parser() -> argparse.ArgumentParser:
    """Options of `workbench`."""
    what = (
        "Serve a page on which runs are loaded and compared, effects tried by hand, values dragged, and the error "
        "watched as it falls; on a running rig too."
    )
    options = recording_options("workbench", what, effects=True, recordings="*", json=False)
    options.set_defaults(output=Path("workbench"))
    options.add_argument(
        "--host", default="127.0.0.1", help="address to listen at (default: this machine only)"
    )
    options.add_argument(
        "--port", type=int, default=8477, help="port; 0: any that is free (default: %(default)s)"
    )
    options.add_argument("--certificate", metavar="FILE", type=Path, help="serve HTTPS with this certificate")
    options.add_argument("--key", metavar="FILE", type=Path, help="the certificate's key")
    options.add_argument(
        "--unencrypted", action="store_true", help="let others on the network in without a certificate"
    )
    options.add_argument("--no-browser", dest="browser", action="store_false", help="open no browser")
    options.add_argument("--no-rig", dest="rig", action="store_false", help="do not listen to a running rig")
    options.add_argument("--namespace", default="/hasel", help="of the rig (default: %(default)s)")
    options.add_argument(
        "--bench", action="store_true", help="measure in a browser how fast the page answers, and end"
    )
    return options
