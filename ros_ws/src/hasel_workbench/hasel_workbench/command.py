# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`workbench [RECORDING…]`: a page in the browser on which the four steps are done by hand."""

import argparse
import signal
import sys
from collections.abc import Sequence
from contextlib import ExitStack
from importlib.util import find_spec
from pathlib import Path

from hasel_recording.reading import drive_of_each
from hasel_sim.parallel import executor
from hasel_sysid.command_line.running import run_command, workers
from hasel_sysid.errors import SysidError

from hasel_workbench.entry import workbench_parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return run(workbench_parser().parse_args(arguments))


def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code."""
    return run_command(lambda: _serve(options))


def _serve(options: argparse.Namespace) -> None:
    if find_spec("nicegui") is None:
        raise SysidError(
            "the workbench needs NiceGUI 3, which is not installed: `pip install 'nicegui>=3,<4'` into the environment "
            "of this workspace"
        )
    from hasel_workbench.jobs import Jobs, Progress
    from hasel_workbench.live.rig import RunningRig
    from hasel_workbench.page.access import opening
    from hasel_workbench.page.server import serve
    from hasel_workbench.recordings import ReadingChoices
    from hasel_workbench.workbench import Workbench

    certificate = _certificate(options)
    if told := opening(options.host, certificate, options.unencrypted):
        print(f"note: {told}", file=sys.stderr)
    paths = [*options.recordings, *options.validate]
    drives = dict(zip(map(str, paths), drive_of_each(paths, options.drive), strict=True))
    drives = {path: Path(drive) for path, drive in drives.items() if drive is not None}
    reading = ReadingChoices(options.map, drives)
    jobs, rig = Jobs(), RunningRig()
    with ExitStack() as open_:
        open_.callback(signal.signal, signal.SIGTERM, signal.signal(signal.SIGTERM, _end))
        pool = open_.enter_context(workers(options))
        hand = open_.enter_context(executor(2))  # of its own: what is dragged never waits for a search
        effects = tuple(options.effects) if options.effects else None
        session = Workbench(pool, hand, options.output.resolve(), options.model, effects, reading)
        open_.callback(rig.close)
        if options.rig and (why := rig.connect(options.namespace)):
            print(f"note: {why}", file=sys.stderr)

        def begin(progress: Progress) -> None:
            if options.validate:
                session.load(options.validate, True, progress)
            session.load(options.recordings, False, progress)

        if paths:
            jobs.start("load", begin)
        open_.callback(jobs.cancel)
        if options.bench:
            serve(session, jobs, rig, options.host, 0, False, _visit, certificate)
        else:
            serve(session, jobs, rig, options.host, options.port, options.browser, None, certificate)


def _end(number: int, _frame: object) -> None:
    raise SystemExit(128 + number)  # what is open is closed on the way, also the processes


def _certificate(options: argparse.Namespace) -> tuple[Path, Path] | None:
    given = (options.certificate, options.key)
    if given == (None, None):
        return None
    if None in given:
        raise SysidError("a certificate needs its key; give both --certificate FILE and --key FILE")
    missing = [str(path) for path in given if not path.is_file()]
    if missing:
        raise SysidError(f"there is no file {missing[0]}; check the name of the certificate and of its key")
    return given


def _visit(address: str) -> None:
    from hasel_workbench.browser import measure

    try:
        measure(address, lambda line: print(line, flush=True))
    except SysidError as error:
        print(f"error: {error}", file=sys.stderr)


if __name__ == "__main__":
    sys.exit(main())
