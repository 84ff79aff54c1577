"""Electrical cross-talk: part of each muscle's voltage appears on the other one's electrodes."""

from hasel_sim.effects.base import DriveEffect, DriveStage, EffectParameter


class CrossTalk(DriveEffect):
    """Capacitive coupling between the leads of the two muscles."""

    physics = "Stray capacitance between the two leads couples part of each voltage into the other muscle."
    equation = "V_upper <- V_upper + c V_lower, V_lower <- V_lower + c V_upper"
    parameters = (
        EffectParameter("coupling", symbol="c", unit="1", null=0.0, lower=0.0, upper=0.8, typical=0.4),
    )
    stage = DriveStage.ELECTRODE

    def respond(self, time, signal, p):
        """Voltage [V] [n, 2] on the upper and lower muscle's electrodes, from the supply's."""
        return signal + p.coupling * signal[:, ::-1]
