# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Calibration: the corrections, and the procedure on a supply that needs them."""

import sys
import time
from contextlib import contextmanager

import pytest
from hasel_driver.protocol.calibration import Calibration, CalibrationTable, Point
from hasel_driver.protocol.faults import Fault, FaultCode, FaultStore, LimitError, RefusedError
from hasel_driver.tools import calibrate_supply


def table(present: Calibration, voltages=(1000.0, 3000.0, 5000.0)) -> CalibrationTable:
    """As measured on a converter of gain 0.97 and offset 20 V, with a monitor of gain 1.04 and offset −30 V."""
    points = []
    for asked_v in voltages:
        probe_v = 0.97 * present.set_point_v(asked_v) + 20.0
        points.append(Point(asked_v, present.measured_v(1.04 * probe_v - 30.0), probe_v))
    return CalibrationTable(tuple(points), present)


@pytest.mark.parametrize("present", [Calibration(), Calibration(10_100, 5, 9_900, -7)])
def test_corrections_undo_gains_and_offsets(present):
    """Whatever was corrected before: afterwards output and monitor agree with the probe within a volt or two."""
    corrected = table(table(present).corrections())
    for point in corrected.points:
        assert point.probe_v == pytest.approx(point.asked_v, abs=2.0)
        assert point.monitor_v == pytest.approx(point.probe_v, abs=2.0)


def test_a_table_that_proves_nothing_is_refused():
    """Too few points, too close, or a divider that is plainly wrong."""
    with pytest.raises(LimitError, match="too few"):
        table(Calibration(), (1000.0, 5000.0)).corrections()
    with pytest.raises(LimitError, match="too few"):
        table(Calibration(), (1000.0, 1100.0, 1200.0)).corrections()
    swapped = CalibrationTable(tuple(Point(v, v / 2, v) for v in (1000.0, 2000.0, 3000.0)), Calibration())
    with pytest.raises(LimitError, match="read_gain would be 20000"):
        swapped.corrections()


def test_the_procedure_makes_board_and_probe_agree(rig, monkeypatch):
    """Measured, stored, measured again: errors of 100 V and more become less than the monitor's step or two."""
    monkeypatch.setattr(calibrate_supply, "SETTLING_S", 0.3)
    rig.say("miscalibrate")
    voltages_v = (1000.0, 3000.0, 5000.0)

    def run() -> CalibrationTable:
        return calibrate_supply.measure(
            rig.port, "upper", voltages_v, lambda _: rig.ask("output")[0], lambda _: True
        )

    before = run()
    assert abs(before.points[-1].probe_v - 5000.0) > 100
    corrections = before.corrections()
    assert calibrate_supply.store(rig.port, "upper", corrections) == corrections
    for point in run().points:
        assert point.probe_v == pytest.approx(point.asked_v, abs=15)
        assert point.monitor_v == pytest.approx(point.probe_v, abs=25)
    rig.await_live(False)


def test_an_empty_answer_stops(rig, monkeypatch, capsys):
    """Nothing is stored, and the output is grounded."""
    monkeypatch.setattr(calibrate_supply, "SETTLING_S", 0.1)
    monkeypatch.setattr("builtins.input", lambda _: "")
    assert calibrate_supply.main(["--port", rig.port, "--channel", "lower"]) == 1
    assert "nothing was stored" in capsys.readouterr().err
    rig.await_live(False)


def test_nothing_is_put_on_without_leave_nor_above_the_maximum(rig):
    """Each voltage is asked for first; one above the maximum is refused before anything is armed."""
    with pytest.raises(RefusedError, match="at most 6000 V"):
        calibrate_supply.measure(rig.port, "upper", (1000.0, 9800.0), lambda _: 0.0, lambda _: True)
    with pytest.raises(RefusedError, match="Stopped"):
        calibrate_supply.measure(rig.port, "upper", (1000.0, 2000.0, 3000.0), lambda _: 0.0, lambda _: False)
    assert max(rig.ask("output")[4:]) < 50
    with pytest.raises(RefusedError, match="Stopped"):
        calibrate_supply.measure(
            rig.port, "upper", (1000.0, 2000.0, 3000.0), lambda _: 0.0, lambda asked: asked < 1000
        )
    assert 200 < max(rig.ask("output")[4:]) < 550  # the proof of ground, with leave
    rig.await_live(False)


def test_a_fault_that_the_node_left_counts_here_too(rig, tmp_path, capsys):
    """A stop that nobody cleared: nothing is armed."""
    FaultStore(str(tmp_path), rig.port).keep(Fault(FaultCode.EMERGENCY_STOP, "by service"))
    words = ["--port", rig.port, "--channel", "upper", "--state-folder", str(tmp_path)]
    assert calibrate_supply.main(words) == 1
    assert "left a fault (emergency stop: by service): clear it there first" in capsys.readouterr().err


def test_without_an_answer_the_output_is_grounded(rig, monkeypatch):
    """Whoever asked has gone: 0 V, and a late answer stores nothing."""
    monkeypatch.setattr(calibrate_supply, "SETTLING_S", 0.3)
    monkeypatch.setattr(calibrate_supply, "PATIENCE_S", 0.3)
    dead_s: list[float] = []

    def probe(_: float) -> float:
        begun_s = time.monotonic()
        dead_s.append(rig.await_live(False) - begun_s)
        return 3000.0

    with pytest.raises(RefusedError, match="Nobody answered"):
        calibrate_supply.measure(rig.port, "upper", (3000.0, 4000.0, 5000.0), probe, lambda _: True)
    assert dead_s[0] < 0.8


def test_a_stop_is_heard_while_the_probe_is_read(rig, monkeypatch):
    """From ROS or elsewhere: grounded at once, and nothing is stored."""
    monkeypatch.setattr(calibrate_supply, "SETTLING_S", 0.3)
    stops = []

    @contextmanager
    def listen(stop):
        stops.append(stop)
        yield

    def probe(_: float) -> float:
        stopped_s = time.monotonic()
        stops[0]("by topic, from /panel")
        assert rig.await_live(False) - stopped_s < 0.5
        return 3000.0

    with pytest.raises(RefusedError, match="emergency stop"):
        calibrate_supply.measure(
            rig.port, "upper", (3000.0, 4000.0, 5000.0), probe, lambda _: True, listen=listen
        )


@pytest.mark.parametrize(
    "words", [["--voltages", "nan,1,2"], ["--voltages", "1,x"], ["--maximum-voltage", "inf"]]
)
def test_no_number_is_one_sentence(words, capsys):
    """Before a port is opened."""
    with pytest.raises(SystemExit) as ended:
        calibrate_supply.main(["--port", "/dev/no-such-port", "--channel", "upper", *words])
    assert ended.value.code == 2
    assert "--voltages" in capsys.readouterr().err.splitlines()[-1]


def test_the_stops_of_ros_are_heard():
    """By topic and by service; the service's answer proves nothing, and says so."""
    pytest.importorskip("rclpy", reason="ROS 2 is not there")
    from hasel_driver.nodes.middleware import UNNAMED
    from hasel_driver.testing.ros_client import RosClient
    from hasel_driver.tools.calibrate_supply import stops_of_ros

    heard: list[str] = []
    client = RosClient()
    try:
        with stops_of_ros(heard.append):
            answer = client.trigger("emergency_stop")
            assert (answer.success, heard) == (False, ["by service"])
            client.emergency_stop_topic(True)
            client.wait(lambda: len(heard) > 1)
            # A stop is not delayed until the network knows the name of who sent it.
            assert heard[1:] in (["by topic, from /user"], [f"by topic, from {UNNAMED}"])
    finally:
        client.close()


def test_the_stops_of_another_namespace_are_heard_where_it_is_given(monkeypatch, capsys):
    """As any node takes it; what is heard is said, and what is there and is not."""
    pytest.importorskip("rclpy", reason="ROS 2 is not there")
    from hasel_driver.testing.ros_client import LATCHED, another_node
    from hasel_driver.tools.calibrate_supply import stops_of_ros
    from std_msgs.msg import Bool

    heard: list[str] = []
    with another_node("panel") as node:
        node.create_publisher(Bool, "/hasel/emergency_stop", LATCHED)
        publisher = node.create_publisher(Bool, "/rig2/emergency_stop", LATCHED)
        publisher.publish(Bool(data=True))
        monkeypatch.setattr(sys, "argv", ["calibrate", "--ros-args", "-r", "__ns:=/rig2"])
        with stops_of_ros(heard.append):
            assert any("by topic" in each for each in heard)
    told = capsys.readouterr().out
    assert "heard on /rig2/emergency_stop only, and there is /hasel/emergency_stop too" in told


def test_arguments_for_ros_are_left_to_it(rig, monkeypatch, capsys):
    """The namespace is no unknown option."""
    monkeypatch.setattr("builtins.input", lambda _: "")
    words = ["--port", rig.port, "--channel", "lower", "--ros-args", "-r", "__ns:=/rig2"]
    assert calibrate_supply.main(words) == 1
    assert "nothing was stored" in capsys.readouterr().err
