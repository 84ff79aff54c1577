# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`check RECORDING…`: what was understood of recordings, and what looks wrong, before anything is fitted."""

import argparse
import sys
from collections.abc import Sequence
from dataclasses import replace

from hasel_common.command_entry import BAD_INPUT
from hasel_recording import Recording, RecordingError
from hasel_recording.reading import distinct_names, drive_of_each, read_recording
from hasel_sim.model import Model, load_model

from hasel_sysid.command_line.options import check_parser
from hasel_sysid.command_line.running import told, write_json
from hasel_sysid.data_quality.recording_check import Summary, refusal, summary
from hasel_sysid.dataset import for_model
from hasel_sysid.errors import SysidError
from hasel_sysid.experiment import experiment_of, is_repeat


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code: 2 where a recording cannot be used or would mislead."""
    return run(check_parser().parse_args(arguments))


@told
def run(options: argparse.Namespace) -> int:
    """Print a summary of each recording; returns the exit code."""
    refused: list[str] = []
    drives = drive_of_each(options.recordings, options.drive)
    model = load_model(options.model) if options.model else None
    shown: list[Summary] = []
    earlier: list[Recording] = []
    names = distinct_names(options.recordings)
    for path, drive, name in zip(options.recordings, drives, names, strict=True):
        try:
            recording = replace(read_recording(path, options.map, drive), name=name)
        except RecordingError as error:
            _refuse(name, str(error), refused)
            continue
        is_repeat(recording, earlier)
        earlier.append(recording)
        fits: tuple[str, ...] = ()
        misfit = False
        try:
            recording, fits = _for(model, recording)
        except SysidError as error:
            misfit = True
            _refuse(recording.name, str(error), refused)
        shown.append(summary(recording, fits, misfit))
        print(shown[-1])
        if not shown[-1].good:
            refused.append(recording.name)
    if options.json:
        write_json({"recordings": [each.to_json() for each in shown], "refused": refused}, options.json)
    if len(options.recordings) > 1:
        names = ", ".join(dict.fromkeys(refused))
        print(
            f"Not to be used as they are: {names}." if refused else "All recordings can be used as they are."
        )
    return BAD_INPUT if refused else 0


def _for(model: Model | None, recording: Recording) -> tuple[Recording, tuple[str, ...]]:
    """The recording with the model's channels, and a sentence that it fits; as it is where it cannot be simulated."""
    if model is None or refusal(recording) is not None:
        return recording, ()
    matched = for_model(model, [experiment_of(recording)])[0].recording
    driven = ", ".join(map(str, matched.channels)) if model.has_muscles else "nothing, a passive body"
    return matched, (f"{model.name}, driven by {driven}: fits",)


def _refuse(name: str, sentence: str, refused: list[str]) -> None:
    print(f"error: {sentence}", file=sys.stderr)
    refused.append(name)


if __name__ == "__main__":
    sys.exit(main())
