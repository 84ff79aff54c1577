# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""One run: rest, waveform, rest; advanced step by step in the safety process."""

from collections.abc import Callable
from dataclasses import dataclass

from hasel_driver.protocol.faults import LimitError
from hasel_driver.protocol.limits import Voltages
from hasel_driver.protocol.status import Mode
from hasel_driver.protocol.waveform import LONGEST_S, FileWaveform, Waveform
from hasel_driver.safety.supervisor import Supervisor

LONGEST_REST_S = 600.0


@dataclass(frozen=True)
class ExperimentPlan:
    """What to run; `rest_s` [s] at 0 V before and after."""

    waveform: Waveform | FileWaveform
    rest_s: float = 0.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.rest_s <= LONGEST_REST_S:
            raise LimitError(f"rest_time is {self.rest_s} s, 0 to {LONGEST_REST_S:g} s was expected.")
        if self.waveform.duration_s > LONGEST_S:
            raise LimitError(
                f"The waveform lasts {self.waveform.duration_s:g} s, at most {LONGEST_S:g} s: ask for less."
            )

    @property
    def duration_s(self) -> float:
        """Time from begin to end [s]."""
        return self.waveform.duration_s + 2 * self.rest_s

    def check_against(self, maximum_v: float, bipolar: bool) -> None:
        """Raises LimitError where the supply would have to clip: such a run is not the one asked for."""
        if self.waveform.voltage_v > maximum_v:
            raise LimitError(
                f"The experiment asks for {self.waveform.voltage_v:g} V, the limit is {maximum_v:g} V:"
                " lower the voltage, or raise the parameter `maximum_voltage`."
            )
        if not bipolar and self.waveform.polarity != "positive":
            raise LimitError(
                f"The polarity is {self.waveform.polarity!r}, this supply gives positive voltages only."
            )


@dataclass(frozen=True)
class ExperimentProgress:
    """Of a run: time since its begin [s], voltage [V], and why it ended early, or None."""

    elapsed_s: float
    voltage_v: Voltages
    finished: bool
    failure: str | None


class DrivenExperiment:
    """Runs a plan on a supervisor. `step` is called often; `failure` tells why it ended early."""

    def __init__(self, plan: ExperimentPlan, supervisor: Supervisor, clock: Callable[[], float]) -> None:
        self.plan = plan
        self._supervisor, self._clock = supervisor, clock
        self.began_s = clock()
        self.ended_s: float | None = None
        self.failure: str | None = None
        self.voltage_v: Voltages = (0.0, 0.0)
        self._drive_began_s: float | None = None
        self._drive_ended_s: float | None = None
        self._row = 0  # of a file, that was sent last
        self._missed_s: list[float] = []  # times of the changes of voltage in it that were not sent

    @property
    def _on_board(self) -> bool:
        return self._supervisor.capabilities.waveforms and isinstance(self.plan.waveform, Waveform)

    @property
    def finished(self) -> bool:
        """Whether the run is over, for good or ill."""
        return self.ended_s is not None

    @property
    def elapsed_s(self) -> float:
        """Time since the begin [s]."""
        return (self._clock() if self.ended_s is None else self.ended_s) - self.began_s

    def progress(self) -> ExperimentProgress:
        """How far it is."""
        return ExperimentProgress(self.elapsed_s, self.voltage_v, self.finished, self.failure)

    def begin(self) -> None:
        """Raises LimitError or RefusedError; then nothing has happened."""
        self.plan.check_against(self._supervisor.maximum_voltage_v, self._supervisor.capabilities.bipolar)
        self._supervisor.begin_experiment()
        self.began_s = self._clock()

    def cancel(self, reason: str = "it was cancelled") -> None:
        """0 V at once."""
        self._finish(reason)

    def step(self) -> None:
        """Do what is due now."""
        if self.finished:
            return
        status = self._supervisor.status()
        self.voltage_v = status.commanded_v
        if not status.mode.may_be_live:
            self._finish(f"the supply left the armed state: {status}")
        elif self._drive_began_s is None:
            if self.elapsed_s >= self.plan.rest_s:
                self._drive_began_s = self._clock()
                self._begin_drive()
        elif self._drive_ended_s is None:
            self._drive(status.mode, self._drive_began_s)
        elif self._clock() >= self._drive_ended_s + self.plan.rest_s:
            self._finish(self._missed())

    def _begin_drive(self) -> None:
        waveform = self.plan.waveform
        if self._on_board and isinstance(waveform, Waveform):
            self._supervisor.start(waveform)
        else:
            self._hold(0.0)

    def _hold(self, driven_s: float) -> None:
        waveform = self.plan.waveform
        self._supervisor.hold(waveform.voltage(driven_s))
        if isinstance(waveform, FileWaveform):
            row = waveform.row(driven_s)
            self._missed_s += waveform.changes_between(self._row, row)
            self._row = row

    def _missed(self) -> str | None:
        """What this machine was too late to send."""
        if not self._missed_s:
            return None
        return (
            f"rows of the file that were not sent: {len(self._missed_s)}, the first that of {self._missed_s[0]:g} s,"
            " as this machine was late: run it again with less to do, or with rows further apart"
        )

    def _drive(self, mode: Mode, began_s: float) -> None:
        driven_s = self._clock() - began_s
        duration_s = self.plan.waveform.duration_s
        if not self._on_board:
            self._hold(driven_s)
            over = driven_s >= duration_s
        else:
            over = driven_s >= duration_s and mode is Mode.ARMED
        if over:
            self._drive_ended_s = self._clock()
        elif driven_s > 1.02 * duration_s + 0.5:  # a ceramic resonator is within 0.5 %
            self._finish(f"the waveform did not end within {duration_s:.3g} s")

    def _finish(self, failure: str | None) -> None:
        if not self.finished:
            self.failure = failure
            self._supervisor.end_experiment()
            self.ended_s = self._clock()
