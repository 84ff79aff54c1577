"""Everything that can be said about where one run fails."""

from dataclasses import dataclass

from hasel_sysid.where_it_fails.component import Component, Kind
from hasel_sysid.where_it_fails.drive_dependence import DriveDependence, drive_dependence
from hasel_sysid.where_it_fails.failure import Failure
from hasel_sysid.where_it_fails.noise import high_frequency_noise
from hasel_sysid.where_it_fails.phase_profile import PhaseProfile, phase_profile
from hasel_sysid.where_it_fails.run_series import RunSeries
from hasel_sysid.where_it_fails.split import split
from hasel_sysid.where_it_fails.whiteness import Whiteness, whiteness

_CLEAR = 4.0
_SHARE_OF_NOISE = 0.75


@dataclass(frozen=True)
class RunAnalysis:
    """components: largest first; failures: those that are clear; noise: rms of sin theta from the fastest part."""

    run: RunSeries
    components: tuple[Component, ...]
    failures: tuple[Failure, ...]
    profile: PhaseProfile | None
    whiteness: Whiteness | None
    drive_dependence: DriveDependence | None
    noise: float


def analyse_run(run: RunSeries) -> RunAnalysis:
    """Split a run's residual and test what is left.

    A component is a failure when it is four standard errors from zero and accounts for more than three quarters of the
    noise; the offset only counts in comparison with other runs.
    """
    components, noise = split(run), high_frequency_noise(run.measured)
    failures = tuple(
        Failure(c, run.name)
        for c in components
        if c.kind is not Kind.OFFSET and c.size > _SHARE_OF_NOISE * noise and c.significance > _CLEAR
    )
    return RunAnalysis(
        run,
        components,
        failures,
        phase_profile(run),
        whiteness(run.residual, run.frame_time),
        drive_dependence(run),
        noise,
    )
