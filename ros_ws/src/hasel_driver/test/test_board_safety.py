# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What the board must not be talked out of: proof of ground, watchdog, interlock, limits; both kinds of board."""

import time

import pytest
from hasel_driver.protocol import wire
from hasel_driver.protocol.status import Ground, Mode

NOT_GROUNDED, OVERVOLTAGE, INTERLOCK = 8, 7, 4


def drive(board, *voltage, settle_s=0.1) -> None:
    """Arm, set, and let it rise."""
    board.arm()
    board.ask("SET", "VOLTAGE", *voltage)
    board.listen(settle_s)


def ask(board, text: str) -> tuple[bool, str]:
    """A command as one text."""
    return board.ask(*text.split())


@pytest.mark.parametrize("how", ["weld", "unground"])
@pytest.mark.parametrize("command", ["STOP", "DISARM"])
def test_ground_is_contact_and_measured_voltage(board, rig, how, command):
    """A muscle that stays charged is never called grounded: FAULT, and neither CLEAR nor ARM is obeyed."""
    drive(board, 5000, 0)
    rig.say(how)
    board.ask(command)
    reports = board.listen(0.3)
    assert rig.live
    assert [report for report in reports[5:] if report.ground] == []
    assert max(abs(volts) for volts in reports[-1].measured) > 2000
    assert reports[-1].mode is Mode.FAULT
    assert board.ask("CLEAR") == (False, "UNPROVEN CLEAR")
    if command == "DISARM":
        assert reports[-1].fault_code == NOT_GROUNDED
    rig.say("recover")
    rig.await_live(False)
    board.listen(0.1)
    assert board.ask("CLEAR") == (True, "CLEAR")
    board.await_proof()
    report = board.report()
    assert (report.mode, report.ground) == (Mode.STANDBY, Ground.PROVEN)


def test_a_charged_output_forbids_arming(board, rig):
    """STANDBY with charge on a muscle becomes FAULT by itself, and ARM is refused until then, too."""
    drive(board, 5000, 0)
    rig.say("unground")
    board.ask("DISARM")
    time.sleep(0.02)
    accepted, answer = board.ask("ARM")
    assert (accepted, answer.split()[0] in ("UNPROVEN", "STATE")) == (False, True)
    board.listen(0.2)
    assert board.report().fault_code == NOT_GROUNDED


@pytest.mark.parametrize("how", ["tickless", "unconverted"])
def test_a_dead_tick_is_noticed_by_the_watchdog(board, rig, how):
    """With the timer interrupt off, or inputs that are converted no more, and the host pinging on, the watchdog grounds
    the output within half a second.
    """
    drive(board, 5000, 0)
    rig.await_live(True)
    dead_s = time.monotonic()
    rig.say(how)
    for index in range(30):
        board.send(wire.encode_command(board.after(index + 1), "PING"))
        time.sleep(0.02)
        if not rig.live:
            break
    assert rig.await_live(False) - dead_s < 0.5
    board.until(lambda: any(event.words[-1] == "reset=watchdog" for event in board.events), cut_off=True)


def test_boots_with_a_maximum_of_nothing(rig, converse):
    """A board that nobody has set up cannot be armed, so an unnoticed reset is harmless."""
    board = converse(rig, maximum_v=None)
    assert board.ask("GET", "MAXIMUM") == (True, "MAXIMUM 0")
    assert board.ask("ARM") == (False, "MAXIMUM ARM")


def test_a_waveform_set_before_is_clipped_to_the_maximum(board, rig):
    """The order of SET WAVEFORM and SET MAXIMUM does not matter."""
    board.ask("SET", "MAXIMUM", 9800)
    ask(board, "SET WAVEFORM box 9800 500 3 1000 positive upper")
    board.ask("SET", "MAXIMUM", 2000)
    assert board.ask("GET", "WAVEFORM") == (True, "WAVEFORM box 2000 500 3 1000 positive upper")
    board.arm()
    board.ask("START")
    reports = board.listen(0.3)
    assert max(report.voltage[0] for report in reports) == 2000
    assert reports[-1].mode is Mode.ACTIVE
    assert max(rig.ask("output")[4:]) < 2050


@pytest.mark.parametrize("drive_by", ["voltage", "waveform"])
def test_the_maximum_may_be_lowered_while_live(board, rig, drive_by):
    """What is above it is discharged by way of ground, comes back with less, and is no fault; raising is refused."""
    if drive_by == "voltage":
        drive(board, 5000, -1000)
    else:
        ask(board, "SET WAVEFORM box 5000 500 9 1000 positive upper")
        board.arm()
        board.ask("START")
        board.listen(0.1)
    assert board.ask("SET", "MAXIMUM", 7000) == (False, "STATE SET MAXIMUM 7000")
    assert board.ask("SET", "MAXIMUM", 2000) == (True, "MAXIMUM 2000")
    report = board.listen(0.3)[-1]
    assert (report.mode, report.fault_code, report.voltage[0], report.maximum) == (Mode.ACTIVE, 0, 2000, 2000)
    assert report.measured[0] == pytest.approx(2000, abs=25)


def test_a_saturated_monitor_is_a_fault(board, rig):
    """Near the end of the monitor's range there is no telling how much there is, whatever MAXIMUM is."""
    board.ask("SET", "MAXIMUM", 9800)
    rig.say("miscalibrate")  # 9800 V asked for give 9506 V, which read 9886 V: within the range
    drive(board, 9800, 0, settle_s=0.2)
    assert board.report().fault_code == 0
    board.ask("DISARM")
    board.listen(0.1)
    ask(board, "SET CALIBRATION upper 10400 0 10000 0")
    drive(board, 9800, 0, settle_s=0.2)
    assert board.report().fault_code == OVERVOLTAGE


def test_ground_at_once_stays_armed(board, rig):
    """GROUND does not wait for the slew limit, ends a waveform, and leaves the board armed at 0 V."""
    board.ask("SET", "SLEW", 20)
    drive(board, 3000, 0, settle_s=0.3)
    asked_s = time.monotonic()
    assert board.ask("GROUND") == (True, "GROUND")
    assert rig.await_live(False) - asked_s < 0.1
    report = board.listen(0.05)[-1]
    assert (report.mode, report.ground, report.voltage) == (Mode.ARMED, Ground.PROVEN, (0, 0))


@pytest.mark.parametrize("channel", ["interlock_a", "interlock_b"])
def test_either_channel_of_the_interlock_grounds(board, rig, channel):
    """One of two is enough, is told, and one that fails alone must be seen open together with the other."""
    drive(board, 5000, 0)
    opened_s = time.monotonic()
    rig.say(channel)
    assert rig.await_live(False) - opened_s < 0.2
    report = board.listen(0.6)[-1]
    assert report.fault_code == INTERLOCK
    assert report.interlock == ((False, True) if channel == "interlock_a" else (True, False))
    assert board.ask("CLEAR") == (False, "INTERLOCK CLEAR")
    rig.say("recover")
    assert board.listen(0.1)[-1].interlock == (True, True)
    assert board.ask("CLEAR") == (False, "DISCREPANCY CLEAR")
    rig.say("interlock")
    board.listen(0.05)
    rig.say("recover")
    board.listen(0.05)
    assert board.ask("CLEAR") == (True, "CLEAR")


def test_an_interlock_that_bounces_for_two_milliseconds_is_no_fault(board, rig):
    """A spike on a long line, or a contact's bounce, does not end an experiment; 3 ms do."""
    drive(board, 5000, 0)
    for _ in range(5):
        rig.say("bounce")
        assert board.listen(0.05)[-1].mode is Mode.ACTIVE
    rig.say("interlock")
    assert board.listen(0.1)[-1].fault_code == INTERLOCK


def test_calibration_corrects_output_and_monitor_and_survives_a_reset(board, rig):
    """Gains and offsets are clipped, kept by the board, and make output and monitor agree with the truth."""
    rig.say("miscalibrate")
    drive(board, 5000, 0)
    assert board.report().measured[0] == pytest.approx(5000 * 0.97 * 1.04, abs=25)
    board.ask("DISARM")
    board.listen(0.05)
    words = "CALIBRATION upper 10309 0 9615 0"
    assert board.ask("SET", *words.split()) == (True, words)
    assert ask(board, "SET CALIBRATION lower 20000 0 0 9999") == (True, "CALIBRATION lower 11000 0 9000 150")
    ask(board, "SET CALIBRATION lower 10000 0 10000 0")
    board.events.clear()
    rig.say("reset")
    board.await_boot()
    assert board.ask("GET", "CALIBRATION", "upper") == (True, words)
    board.ask("SET", "MAXIMUM", 6000)
    drive(board, 5000, 0)
    assert rig.ask("output")[0] == pytest.approx(5000, abs=10)
    assert board.report().measured[0] == pytest.approx(5000, abs=25)


@pytest.mark.parametrize("words", ["CALIBRATION", "CALIBRATION middle 1 1 1 1", "CALIBRATION upper 1 1 1"])
def test_calibration_needs_all_of_its_words(board, words):
    """Anything else is a syntax error, as is a GET without the channel."""
    assert board.ask("SET", *words.split()) == (False, f"SYNTAX SET {words}")
    assert board.ask("GET", "CALIBRATION") == (False, "SYNTAX GET CALIBRATION")


@pytest.mark.parametrize("word", ["+5", "1_0", "0x5", "5.0"])
def test_numbers_are_digits(board, word):
    """What Python takes for a number is none here."""
    assert board.ask("SET", "SLEW", word) == (False, f"SYNTAX SET SLEW {word}")
