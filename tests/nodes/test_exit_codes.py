# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Every node ends with exit code 0, quietly, at Ctrl-C and at a service manager's stop."""

import signal

import pytest
from hasel_bringup.processes import Processes

NODES = {
    "simulator": ("hasel_sim", ": simulation"),
    "sysid": ("hasel_sysid", ": identification"),
    "tracker_node": ("hasel_tracker", ": tracking", "-p", "source:=topic:camera"),
    "driver_node": ("hasel_driver", ": supply", "-p", "port:=/dev/no-such-port", "-p", "history_file:=''"),
}


@pytest.mark.timeout(300)
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=lambda number: number.name)
def test_nodes_end_with_zero(tmp_path, environment, listener, number):
    """All at once, after each has told its diagnostics."""
    with Processes(tmp_path, environment) as processes:
        for name, (package, _, *arguments) in NODES.items():
            processes.start(package, name, "--ros-args", *arguments)
        for _, part, *_ in NODES.values():
            listener.until(
                lambda part=part: any(part in key for key in listener.diagnostics), 100.0, processes.check
            )
        codes = {name: processes.stop(name, number) for name in NODES}
        assert codes == dict.fromkeys(NODES, 0)
        for name in NODES:
            assert "Traceback" not in processes.output(name).read_text()


@pytest.mark.timeout(100)
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=lambda number: number.name)
def test_a_replay_ends_with_zero(tmp_path, environment, listener, number):
    """In the middle of a recording."""
    recording = tmp_path / "run.csv"
    rows = [f"{index / 100},{3000 * (index // 50 % 2)},0,0.0" for index in range(6000)]
    recording.write_text("\n".join(["time_s,voltage_upper_v,voltage_lower_v,sin_theta", *rows]))
    with Processes(tmp_path, environment) as processes:
        processes.start("hasel_bringup", "replay", str(recording))
        listener.until(lambda: len(listener.states) > 5, 60.0, processes.check)
        assert processes.stop("replay", number) == 0
        assert "Traceback" not in processes.output("replay").read_text()
