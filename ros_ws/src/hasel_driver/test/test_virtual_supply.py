# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The virtual supply on a machine that was late: what it reports is as new as it arrives."""

import os
import signal
import time

from hasel_driver.protocol.status import Mode
from hasel_driver.testing.rig import VIRTUAL_SUPPLY, Bench, Rig

HELD_UP_S = 0.3
TIMES = 5


def test_a_board_that_was_held_up_reports_what_is_now():
    """Each time that its process stood still its clock went on, so that its reports are not taken for old ones."""
    rig = Rig(VIRTUAL_SUPPLY)
    bench = Bench(rig)
    try:
        bench.await_mode(Mode.STANDBY)
        for _ in range(TIMES):
            os.kill(rig.process_id, signal.SIGSTOP)
            time.sleep(HELD_UP_S)
            os.kill(rig.process_id, signal.SIGCONT)
            time.sleep(HELD_UP_S)
        assert bench.wait_until(lambda: not bench.status().silent_s, 1.0), bench.status()
        bench.arm()
    finally:
        bench.close()
        rig.close()
