"""`ros2 run hasel_driver bench`: where the executable begins; --help is answered before anything is imported."""

import sys

from hasel_common.command_entry import command

from hasel_driver.bench_options import options_from


@command
def main() -> int:
    """Run the benchmark; returns the exit code."""
    options = options_from()
    from hasel_driver.bench import run

    return run(options)


if __name__ == "__main__":
    sys.exit(main())
