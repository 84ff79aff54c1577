"""`convert`: CSV to MCAP and back."""

import sys

from hasel_recording.command_line import convert_main as main

__all__ = ["main"]

if __name__ == "__main__":
    sys.exit(main())
