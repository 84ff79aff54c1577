"""Split the difference of one run into its components."""

from hasel_sysid.where_it_fails.component import Component
from hasel_sysid.where_it_fails.components.aligned import align
from hasel_sysid.where_it_fails.components.drift import drift
from hasel_sysid.where_it_fails.components.free_swing import free_swing
from hasel_sysid.where_it_fails.components.ringing import ringing
from hasel_sysid.where_it_fails.components.rise_against_fall import rise_against_fall
from hasel_sysid.where_it_fails.components.upper_against_lower import upper_against_lower
from hasel_sysid.where_it_fails.run_series import RunSeries

_FEWEST_FRAMES = 16


def split(run: RunSeries) -> tuple[Component, ...]:
    """All components of a run, largest first; none for fewer than 16 frames.

    A body without drive is described by its swing, a driven one by gain, lag, sides, ringing and drift.
    """
    if len(run.time) < _FEWEST_FRAMES:
        return ()
    aligned = align(run)
    if run.drive_time is None or run.level == 0:
        found = [aligned.components[0], *free_swing(run)]
    else:
        found = [
            *aligned.components,
            rise_against_fall(run, aligned),
            upper_against_lower(run, aligned),
            ringing(run, aligned),
            *drift(run, aligned),
        ]
    return tuple(sorted((c for c in found if c is not None), key=lambda c: -c.size))
