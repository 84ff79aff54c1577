# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 run hasel_driver stored_charge`: what charge and energy wait on the output at a given capacitance.

The bound for touching is that of IEC 60335-1, 8.1.4: 45 µC for peaks of 450 V to 15 kV.
"""

import argparse
import math
import sys
from dataclasses import dataclass

from hasel_common.command_entry import command

TOUCHABLE_CHARGE_C = 45e-6
LOWEST_VOLTAGE_V, HIGHEST_VOLTAGE_V = 450.0, 15_000.0
TOUCHABLE_VOLTAGE_V = 50.0


@dataclass(frozen=True)
class StoredCharge:
    """A charged capacitance [F] at a voltage [V], with its bleeder [Ω]; prints as sentences."""

    capacitance_f: float
    voltage_v: float
    bleeder_ohm: float

    @property
    def charge_c(self) -> float:
        """Q = C V [C]."""
        return self.capacitance_f * self.voltage_v

    @property
    def energy_j(self) -> float:
        """½ C V² [J]."""
        return 0.5 * self.capacitance_f * self.voltage_v**2

    @property
    def largest_capacitance_f(self) -> float:
        """Capacitance that holds the touchable charge at this voltage [F]."""
        return TOUCHABLE_CHARGE_C / self.voltage_v

    @property
    def wait_s(self) -> float:
        """Time for the bleeder alone to bring the voltage below 50 V [s]."""
        return (
            self.bleeder_ohm * self.capacitance_f * math.log(max(1.0, self.voltage_v / TOUCHABLE_VOLTAGE_V))
        )

    def __str__(self) -> str:
        verdict = "below" if self.charge_c <= TOUCHABLE_CHARGE_C else "ABOVE"
        return (
            f"{self.capacitance_f * 1e9:g} nF at {self.voltage_v:g} V hold {self.charge_c * 1e6:.3g} µC and"
            f" {self.energy_j * 1e3:.3g} mJ, {verdict} the 45 µC of IEC 60335-1 (at this voltage:"
            f" {self.largest_capacitance_f * 1e9:.3g} nF). Through {self.bleeder_ohm / 1e6:g} MΩ alone it takes"
            f" {self.wait_s:.3g} s to fall below {TOUCHABLE_VOLTAGE_V:g} V."
        )


@command
def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(prog="stored_charge", description=__doc__.splitlines()[0])
    parser.add_argument(
        "--capacitance-nf", type=float, default=1.5, help="muscles, cables and converter [nF]"
    )
    parser.add_argument("--voltage-v", type=float, default=10_000.0, help="highest voltage [V]")
    parser.add_argument("--bleeder-mohm", type=float, default=1000.0, help="bleeder across the output [MΩ]")
    arguments = parser.parse_args()
    if not LOWEST_VOLTAGE_V <= arguments.voltage_v <= HIGHEST_VOLTAGE_V:
        sys.exit(
            f"The voltage is {arguments.voltage_v:g} V; the bound holds for 450 V to 15000 V: choose one there."
        )
    if arguments.capacitance_nf <= 0 or arguments.bleeder_mohm <= 0:
        sys.exit("Capacitance and bleeder must be greater than 0: give both as positive numbers.")
    print(StoredCharge(arguments.capacitance_nf * 1e-9, arguments.voltage_v, arguments.bleeder_mohm * 1e6))


if __name__ == "__main__":
    sys.exit(main())
