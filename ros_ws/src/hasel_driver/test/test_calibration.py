"""Calibration: the corrections, and the procedure on a supply that needs them."""

import pytest
from hasel_driver import calibrate
from hasel_driver.calibration import Calibration
from hasel_driver.calibration_table import CalibrationTable, Point
from hasel_driver.errors import LimitError


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
    monkeypatch.setattr(calibrate, "SETTLING_S", 0.3)
    rig.say("miscalibrate")
    voltages_v = (1000.0, 3000.0, 5000.0)

    def run() -> CalibrationTable:
        return calibrate.measure(
            rig.port, "upper", voltages_v, lambda _: rig.ask("output")[0], lambda _: True
        )

    before = run()
    assert abs(before.points[-1].probe_v - 5000.0) > 100
    corrections = before.corrections()
    assert calibrate.store(rig.port, "upper", corrections) == corrections
    for point in run().points:
        assert point.probe_v == pytest.approx(point.asked_v, abs=15)
        assert point.monitor_v == pytest.approx(point.probe_v, abs=25)
    rig.await_live(False)


def test_an_empty_answer_stops(rig, monkeypatch, capsys):
    """Nothing is stored, and the output is grounded."""
    monkeypatch.setattr(calibrate, "SETTLING_S", 0.1)
    monkeypatch.setattr("builtins.input", lambda _: "")
    assert calibrate.main(["--port", rig.port, "--channel", "lower"]) == 1
    assert "nothing was stored" in capsys.readouterr().err
    rig.await_live(False)
