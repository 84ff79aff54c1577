# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Ctrl-C in a launch file reaches a node twice: from the terminal and from the launcher."""

import os
import signal
import time

import pytest
from hasel_bringup.processes import Processes


@pytest.mark.parametrize(
    ("package", "executable", "name"),
    [
        ("hasel_sim", "simulator", "simulation"),
        pytest.param("hasel_sysid", "sysid", "identification", marks=pytest.mark.slow),
    ],
)
def test_a_second_interrupt_does_not_break_the_clean_up(
    tmp_path, environment, listener, package, executable, name
):
    """The node ends with exit code 0, without a stack trace."""
    with Processes(tmp_path, environment) as processes:
        processes.start(package, executable)
        listener.until(lambda: any(name in key for key in listener.diagnostics), 60.0, processes.check)
        number = processes.process_id(executable)
        os.kill(number, signal.SIGINT)
        time.sleep(0.02)
        os.kill(number, signal.SIGINT)
        assert processes.finish(executable, 20.0) == 0
        assert "Traceback" not in processes.output(executable).read_text()
