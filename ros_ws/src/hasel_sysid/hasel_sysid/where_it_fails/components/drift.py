"""Whether the bending grows, fades or wanders over the cycles."""

import numpy as np

from hasel_sysid.where_it_fails.component import Component, Kind
from hasel_sysid.where_it_fails.components.added import explained_by
from hasel_sysid.where_it_fails.components.aligned import Alignment
from hasel_sysid.where_it_fails.run_series import RunSeries


def drift(run: RunSeries, aligned: Alignment) -> tuple[Component, Component]:
    """Change of the gain per second, relative to the gain [1/s], and of the offset [1/s]."""
    elapsed = run.time - run.time.mean()
    columns = np.column_stack([elapsed * aligned.shifted, elapsed])
    found = []
    for column in columns.T:
        fitted, size = explained_by(aligned, column[:, None], run.frame_time)
        found.append((float(fitted.coefficients[0]), float(fitted.standard_errors[0]), size))
    (gain, gain_error, gain_size), (offset, offset_error, offset_size) = found
    scale = abs(aligned.gain) or 1.0
    return (
        Component(Kind.GAIN_DRIFT, gain / scale, gain_error / scale, "1/s", gain_size),
        Component(Kind.OFFSET_DRIFT, offset, offset_error, "1/s", offset_size),
    )
