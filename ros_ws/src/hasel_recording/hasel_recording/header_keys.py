"""The header lines of a recording that mean something."""

KNOWN_KEYS = {
    "model": "model to use where --model is not given; one with an effect of your own, which is code, wants --model",
    "initial_state": "rest (default) or static_equilibrium",
    "initial_load_factor": "times all loads that act in static_equilibrium (default 1)",
    "initial_time_s": "when the body is let go (default: first frame or switch)",
    "drive": "file of the drive, beside the recording",
    "volts_per_<unit>": "the voltage columns stand for another quantity, such as volts_per_mbar: 10",
    "voltage_v": "voltage that was asked for, compared with the column",
    "frequency_hz": "frequency that was asked for, compared with the column",
    "muscles": "both, lower_first, upper or lower: which were meant to be driven",
}
"""Key and what it says; any other key is kept as a note."""
