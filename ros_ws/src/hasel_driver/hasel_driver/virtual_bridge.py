"""Output stage of one channel: polarity contacts with break before make, and the slew limit."""

from dataclasses import dataclass

from hasel_driver.limits import DISCHARGED_V
from hasel_driver.virtual_muscle import Contact


@dataclass
class VirtualBridge:
    """Moves contacts and set point towards a wanted voltage, one millisecond at a time."""

    contact: Contact = Contact.GROUND
    set_point_v: float = 0.0
    _dwell_ms: int = 0  # ticks in the present contact, the first of which may be cut short
    _opened_from: Contact = Contact.GROUND

    @property
    def grounded(self) -> bool:
        """Whether the ground contact is closed."""
        return self.contact is Contact.GROUND

    def release(self) -> None:
        """Cut the set point and open the source at once; the ground contact follows after the dead time."""
        self.set_point_v = 0.0
        if self.contact.sign:
            self._move(Contact.OPEN)

    def step(self, wanted_v: float, slew_v: float, measured_v: float, dead_time_ms: int) -> None:
        """One millisecond towards `wanted_v` [V], the set point moving by at most `slew_v` [V]."""
        self._dwell_ms += 1
        polarity = Contact.POSITIVE if wanted_v > 0 else Contact.NEGATIVE if wanted_v < 0 else Contact.GROUND
        if self.contact is Contact.OPEN:
            self._leave_open(polarity, dead_time_ms)
        elif self.contact is Contact.GROUND:
            discharged = abs(measured_v) < DISCHARGED_V
            if polarity is not Contact.GROUND and discharged and self._dwell_ms > dead_time_ms:
                self._move(Contact.OPEN)
        elif self.contact is polarity:
            change = abs(wanted_v) - self.set_point_v
            self.set_point_v += min(max(change, -slew_v), slew_v)
        elif self.set_point_v > slew_v:
            self.set_point_v -= slew_v
        else:
            self.release()

    def _leave_open(self, polarity: Contact, dead_time_ms: int) -> None:
        if self._dwell_ms <= dead_time_ms:
            return
        # A source that was just opened is followed by ground, never by the other source.
        self._move(Contact.GROUND if self._opened_from.sign else polarity)

    def _move(self, contact: Contact) -> None:
        self._opened_from, self.contact, self._dwell_ms = self.contact, contact, 0
