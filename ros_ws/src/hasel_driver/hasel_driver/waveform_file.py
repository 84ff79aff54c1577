"""A drive given as a file: CSV with time_s, voltage_upper_v and voltage_lower_v, each row holding until the next."""

from pathlib import Path

import numpy as np
from hasel_recording.csv_columns import understand
from hasel_recording.csv_numbers import CsvNumbers
from hasel_recording.csv_run import drive_columns
from hasel_recording.csv_text import read_text
from hasel_recording.drive_channel import HASEL_PAIR
from hasel_recording.errors import RecordingError

from hasel_driver.errors import LimitError
from hasel_driver.limits import HARDWARE_MAXIMUM_V
from hasel_driver.waveform import LONGEST_S, FileWaveform

SHORTEST_ROW_S = 0.0099


def read_waveform(path: Path) -> FileWaveform:
    """The drive in a CSV file.

    Raises:
        RecordingError: it cannot be read, or lacks a column.
        LimitError: times or voltages that no supply can give.
    """
    if not path.is_file():
        raise RecordingError(
            f"There is no waveform file {path}: check the name, as seen from the driver's machine."
        )
    text = read_text(path)
    columns = understand(text.names, {}, str(path), angle=False)
    numbers = CsvNumbers(text)
    time_s = numbers.times(columns.time)
    channels, voltages_v, _ = drive_columns(columns, numbers, text)
    if voltages_v is None or channels != HASEL_PAIR:
        expected = " and ".join(channel.column for channel in HASEL_PAIR)
        raise RecordingError(f"{path} has the columns {', '.join(text.names)}: {expected} were expected.")
    if len(time_s) < 2 or not 0.0 < time_s[-1] - time_s[0] <= LONGEST_S:
        raise LimitError(
            f"{path} lasts from its first row to its last: more than 0 and at most {LONGEST_S:g} s."
        )
    closest_s = float(np.diff(time_s).min())
    if closest_s < SHORTEST_ROW_S:
        raise LimitError(
            f"{path} has rows {closest_s * 1e3:.3g} ms apart, and the driver sends one in 10 ms:"
            " at least that was expected."
        )
    if not np.isfinite(voltages_v).all() or np.abs(voltages_v).max() > HARDWARE_MAXIMUM_V:
        raise LimitError(f"{path} holds a voltage that is no number, or above {HARDWARE_MAXIMUM_V:g} V.")
    return FileWaveform(path, time_s - time_s[0], voltages_v)
