"""A lag that one channel has and the other has not."""

import numpy as np

from hasel_sysid.data_gate.finding import DataFinding, warning
from hasel_sysid.where_it_fails.components.added import explained_by
from hasel_sysid.where_it_fails.components.aligned import Alignment
from hasel_sysid.where_it_fails.run_series import RunSeries

_CLEAR = 5.0
_LEAST_S = 0.004


def check_channel_lag(run: RunSeries, aligned: Alignment) -> list[DataFinding]:
    """Compare the lag after switches to the upper muscle with that after switches to the lower one."""
    if (
        run.cycle is None
        or len(run.channels) != 2
        or not (np.any(run.cycle.side > 0) and np.any(run.cycle.side < 0))
    ):
        return []
    _, side = run.cycle.since_switch(run.time - aligned.lag)
    fitted, size = explained_by(aligned, (-aligned.gain * aligned.rate * side)[:, None], run.frame_time)
    half, error = float(fitted.coefficients[0]), float(fitted.standard_errors[0])
    share = size**2 / max(float(np.mean(aligned.remainder**2)), 1e-30)
    if abs(half) < max(0.5 * _LEAST_S, _CLEAR * error) or share < 0.5:
        return []
    upper, lower = (aligned.lag + half) * 1e3, (aligned.lag - half) * 1e3
    evidence = (
        f"the angle lags {upper:.0f} ms behind the {run.channels[0].name} and {lower:.0f} ms behind the "
        f"{run.channels[1].name} command"
    )
    return [warning("channel lag", 2 * half, evidence, "compare the supply's channels with an oscilloscope")]
