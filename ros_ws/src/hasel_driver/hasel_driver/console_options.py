"""What `console` says of itself, without anything that takes time to import."""

import argparse

DESCRIPTION = """`ros2 run hasel_driver console`: arm, ramp, hold and stop by hand, with the voltages shown live.

While a voltage is on, ANY KEY STOPS: the output is grounded and the driver is in FAULT."""
HELP = """  arm                    STANDBY to ARMED
  ramp UPPER LOWER [S]   to these voltages [V], hold for S seconds (default: until a key stops), and back to 0
  rate V                 ramp by V volts a second (1000 at first)
  limit V                lower the driver's maximum voltage
  disarm                 to STANDBY, grounded
  stop                   emergency stop
  release                take back what the emergency stop's topic holds
  clear                  FAULT to STANDBY
  state                  what the supply is doing
  quit                   disarm and leave"""


def parser() -> argparse.ArgumentParser:
    """The command's options."""
    options = argparse.ArgumentParser(
        prog="console",
        description=DESCRIPTION,
        epilog=HELP,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    options.add_argument("--namespace", default="/hasel", help="of the driver (default: /hasel)")
    return options
