"""Electrical behaviour of one muscle on its 10 kV, 5 W converter: charging, current limit, slow discharge."""

import math
from dataclasses import dataclass
from enum import Enum


class Contact(Enum):
    """What the output stage connects the muscle to."""

    GROUND = 0
    OPEN = 1
    POSITIVE = 2
    NEGATIVE = 3

    @property
    def sign(self) -> int:
        """Polarity of the source, 0 where it is not connected."""
        return {Contact.POSITIVE: 1, Contact.NEGATIVE: -1}.get(self, 0)


@dataclass
class VirtualMuscle:
    """A capacitor with leakage behind a converter that can source but not sink current."""

    capacitance_f: float = 0.5e-9
    leakage_ohm: float = 1e9
    ground_ohm: float = 2e6
    current_limit_a: float = 500e-6  # 5 W at 10 kV
    short_ohm: float = math.inf  # injected fault
    voltage_v: float = 0.0
    current_a: float = 0.0

    def step(self, duration_s: float, contact: Contact, set_point_v: float) -> None:
        """Advance by `duration_s` with the converter's magnitude at `set_point_v` [V]."""
        parallel_ohm = 1.0 / (1.0 / self.leakage_ohm + 1.0 / self.short_ohm)
        if contact is Contact.GROUND:
            parallel_ohm = 1.0 / (1.0 / parallel_ohm + 1.0 / self.ground_ohm)
        decay = math.exp(-duration_s / (parallel_ohm * self.capacitance_f))
        rest_v = self.voltage_v * decay
        self.current_a = 0.0
        if contact.sign:
            # Voltage that a constant current adds within the step is current × gain.
            gain_ohm = parallel_ohm * (1.0 - decay)
            wanted_a = (set_point_v - contact.sign * rest_v) / gain_ohm
            self.current_a = min(max(wanted_a, 0.0), self.current_limit_a)
            rest_v += contact.sign * self.current_a * gain_ohm
        self.voltage_v = rest_v
