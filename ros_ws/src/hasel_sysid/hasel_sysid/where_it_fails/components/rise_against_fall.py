"""Whether the body lags more while it bends away from straight than while it comes back."""

import numpy as np

from hasel_sysid.where_it_fails.component import Component, Kind
from hasel_sysid.where_it_fails.components.added import explained_by
from hasel_sysid.where_it_fails.components.aligned import Alignment
from hasel_sysid.where_it_fails.run_series import RunSeries


def rise_against_fall(run: RunSeries, aligned: Alignment) -> Component:
    """Lag while bending away minus lag while coming back [s]."""
    away = np.sign(run.simulated * np.gradient(run.simulated, run.time))
    fitted, size = explained_by(aligned, (-aligned.gain * aligned.rate * away)[:, None], run.frame_time)
    return Component(
        Kind.RISE_AGAINST_FALL,
        2.0 * float(fitted.coefficients[0]),
        2.0 * float(fitted.standard_errors[0]),
        "s",
        size,
        {
            "rise_lag_s": aligned.lag + float(fitted.coefficients[0]),
            "fall_lag_s": aligned.lag - float(fitted.coefficients[0]),
        },
    )
