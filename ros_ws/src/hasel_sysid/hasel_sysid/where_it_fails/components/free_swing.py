"""How fast and how long a body that is let go swings, against the simulation."""

import numpy as np

from hasel_sysid.where_it_fails.component import Component, Kind
from hasel_sysid.where_it_fails.run_series import RunSeries
from hasel_sysid.where_it_fails.swing import fit_swing, swing_at


def free_swing(run: RunSeries) -> tuple[Component, ...]:
    """Relative difference of the frequency [1] and difference of the decay [1/s], measured against simulated."""
    measured, simulated = fit_swing(run.time, run.measured), fit_swing(run.time, run.simulated)
    if measured is None or simulated is None:
        return ()
    elapsed = run.time - run.time[0]

    def changed(index: int, value: float) -> float:
        parameters = simulated.parameters.copy()
        parameters[index] = value
        return float(np.std(swing_at(elapsed, *parameters) - swing_at(elapsed, *simulated.parameters)))

    ratio = measured.frequency / simulated.frequency
    frequency_error = ratio * np.hypot(
        measured.frequency_error / measured.frequency, simulated.frequency_error / simulated.frequency
    )
    return (
        Component(
            Kind.SWING_FREQUENCY,
            ratio - 1.0,
            float(frequency_error),
            "1",
            changed(3, measured.frequency),
            {"measured_hz": measured.frequency, "simulated_hz": simulated.frequency},
        ),
        Component(
            Kind.SWING_DECAY,
            measured.decay - simulated.decay,
            float(np.hypot(measured.decay_error, simulated.decay_error)),
            "1/s",
            changed(4, measured.decay),
            {
                "measured_damping_ratio": float(measured.damping_ratio),
                "simulated_damping_ratio": float(simulated.damping_ratio),
            },
        ),
    )
