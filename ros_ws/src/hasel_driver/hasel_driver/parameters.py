"""The node's parameters: names, defaults, units, ranges; declared in the node and listed in the README."""

from dataclasses import dataclass

from hasel_driver.errors import LimitError


@dataclass(frozen=True)
class Parameter:
    """One parameter; numbers have a range."""

    name: str
    default: str | float | bool | list[str]
    unit: str
    description: str
    low: float | None = None
    high: float | None = None
    choices: tuple[str, ...] = ()

    def check(self, value: object) -> None:
        """Raises LimitError for a value outside range or choices."""
        if self.low is not None and not self.low <= float(value) <= self.high:
            raise LimitError(
                f"{self.name} is {value} {self.unit}, {self.low:g} to {self.high:g} was expected."
            )
        if self.choices and value not in self.choices:
            raise LimitError(f"{self.name} is {value!r}, one of {', '.join(self.choices)} was expected.")


PARAMETERS: tuple[Parameter, ...] = (
    Parameter("port", "/dev/ttyACM0", "", "serial port of the supply (with shvps: of the upper muscle's)"),
    Parameter("backend", "hasel", "", "protocol of the supply", choices=("hasel", "shvps")),
    Parameter("second_port", "", "", "serial port of the lower muscle's supply (shvps only)"),
    Parameter("maximum_voltage", 6000.0, "V", "commands are clipped to ± this", 0.0, 10_000.0),
    Parameter("slew_rate", 400.0, "V/ms", "steepest change of the set point", 1.0, 2000.0),
    Parameter(
        "trip_current", 450e-6, "A", "converter current at which the board latches a fault", 1e-6, 1e-3
    ),
    Parameter("heartbeat_timeout", 0.3, "s", "silence after which the board grounds its output", 0.1, 0.45),
    Parameter("discovery_time", 1.0, "s", "arming waits this long for a latched emergency stop", 0.0, 60.0),
    Parameter(
        "accept_no_deadman", False, "", "allow arming a supply that stays live when its host dies (shvps)"
    ),
    Parameter(
        "recording_directory", "recordings", "", "where RunExperiment writes when its goal names no file"
    ),
    Parameter(
        "recorded_topics",
        ["/hasel/bending/measured", "/hasel/markers/measured", "/hasel/bending/simulated"],
        "",
        "recorded with /hasel/state; required in the recording when published as the experiment begins",
    ),
    Parameter("autostart", True, "", "configure and activate at start (never arms)"),
)
