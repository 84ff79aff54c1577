"""How fast the simulation runs against time, and how long messages wait for it."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class PaceReport:
    """real_time_factor: simulated over computing time, NaN before there is any; lags [s] from reception to answer."""

    messages: int
    real_time_factor: float
    mean_lag: float
    worst_lag: float

    @property
    def behind(self) -> bool:
        """Whether messages come faster than they are answered."""
        return self.real_time_factor < 1.0 or self.worst_lag > 0.1

    def __str__(self) -> str:
        if self.messages == 0:
            return "no state message in the last second"
        return (
            f"{self.real_time_factor:.1f} times real time, answers after {1e3 * self.mean_lag:.1f} ms"
            f" (at worst {1e3 * self.worst_lag:.1f} ms)"
        )


class Pace:
    """Collects what each message took, between two reports."""

    def __init__(self) -> None:
        self._rows: list[tuple[float, float, float]] = []

    def add(self, simulated: float, computing: float, lag: float) -> None:
        """One message: time simulated, time spent on it, time from its reception to the answer [s]."""
        self._rows.append((simulated, computing, lag))

    def report(self) -> PaceReport:
        """Sum up since the last report."""
        rows, self._rows = np.array(self._rows).reshape(-1, 3), []
        if len(rows) == 0:
            return PaceReport(0, np.nan, np.nan, np.nan)
        simulated, computing, _ = rows.sum(axis=0)
        factor = simulated / computing if simulated > 0 else np.nan
        return PaceReport(len(rows), float(factor), float(rows[:, 2].mean()), float(rows[:, 2].max()))
