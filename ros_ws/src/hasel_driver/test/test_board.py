# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`firmware/PROTOCOL.md`, sentence by sentence, on the virtual board and on the firmware in simavr."""

import itertools
import random
import time

import pytest
from hasel_driver.protocol import wire
from hasel_driver.protocol.status import Ground, Mode
from hasel_driver.protocol.waveform import MUSCLES, POLARITIES, SHAPES, Waveform
from hasel_driver.virtual.virtual_board import SETTINGS

WORDS = [
    "SET",
    "GET",
    "VOLTAGE",
    "WAVEFORM",
    "TRIP",
    "START",
    "CLEAR",
    "sine",
    "both",
    "alternating",
    "-7",
    "9" * 30,
]


def test_boots_commanded_to_ground_and_says_so(board):
    """A reset ends in STANDBY, commanded to ground but not proven, with a banner that names firmware and protocol."""
    assert board.events[0].words[:5] == ("BOOT", *wire.IDENTITY)
    report = board.report()
    assert (report.mode, report.ground, report.fault_code) == (Mode.STANDBY, Ground.COMMANDED, 0)
    assert board.ask("GET", "IDENTITY") == (True, "IDENTITY " + " ".join(wire.IDENTITY))


@pytest.mark.parametrize("name", SETTINGS)
def test_settings_answer_with_the_value_applied(board, name):
    """SET clips to the documented range, GET repeats the value; the heartbeat can be neither off nor above 2 s."""
    least, most, initial = SETTINGS[name]
    assert board.ask("GET", name) == (True, f"{name} {6000 if name == 'MAXIMUM' else initial}")
    for asked, applied in (
        (least - 1, least),
        (most + 1, most),
        (min(least + 3, most),) * 2,
        (-99999, least),
    ):
        assert board.ask("SET", name, asked) == (True, f"{name} {applied}")
        assert board.ask("GET", name) == (True, f"{name} {applied}")


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        ("FLY", "UNKNOWN"),
        ("GET NOTHING", "UNKNOWN"),
        ("SET", "UNKNOWN"),
        ("ARM NOW", "SYNTAX"),
        ("SET SLEW", "SYNTAX"),
        ("SET SLEW fast", "SYNTAX"),
        ("SET SLEW 1 2", "SYNTAX"),
        ("SET SLEW 1000000000", "SYNTAX"),
        ("SET WAVEFORM saw 1000 1000 1 1000 positive both", "SYNTAX"),
        ("SET VOLTAGE 1000 1000", "STATE"),
        ("START", "STATE"),
        ("CLEAR", "STATE"),
    ],
)
def test_refuses_what_it_cannot_do(board, words, reason):
    """Every refusal gives its documented reason and the command's words, and changes nothing."""
    assert board.ask(*words.split()) == (False, f"{reason} {words}")
    assert board.report().mode is Mode.STANDBY


def test_voltage_is_clipped_to_the_maximum(board, rig):
    """A voltage above MAXIMUM is applied, answered and measured as MAXIMUM, with its sign."""
    board.ask("SET", "MAXIMUM", 2000)
    board.arm()
    assert board.ask("SET", "VOLTAGE", 9000, -9000) == (True, "VOLTAGE 2000 -2000")
    report = board.listen(0.3)[-1]
    assert report.voltage == (2000, -2000)
    assert report.measured == pytest.approx((2000, -2000), abs=25)
    assert max(rig.ask("output")[4:]) < 2050


def test_silence_grounds_within_the_heartbeat_timeout(board, rig):
    """Without commands the output is grounded after HEARTBEAT, and the fault stays until CLEAR."""
    board.ask("SET", "HEARTBEAT", 200)
    board.arm()
    board.ask("SET", "VOLTAGE", 3000, 3000)
    silent_s = time.monotonic()
    rig.await_live(True)
    assert 0.15 < rig.await_live(False) - silent_s < 0.3
    assert board.report().fault_code == 1
    assert board.ask("ARM") == (False, "STATE ARM")
    assert board.ask("CLEAR") == (True, "CLEAR")
    assert board.report().mode is Mode.STANDBY


@pytest.mark.parametrize("command", ["STOP", "DISARM"])
def test_stop_and_disarm_ground(board, rig, command):
    """Both ground at once, proven by the fall; after STOP only CLEAR leads on, and not to ARMED."""
    board.arm()
    board.ask("SET", "VOLTAGE", 5000, 0)
    board.listen(0.1)
    asked_s = time.monotonic()
    board.ask(command)
    assert rig.await_live(False) - asked_s < 0.1
    report = board.report()
    assert report.mode is (Mode.FAULT if command == "STOP" else Mode.STANDBY)
    assert report.ground is Ground.PROVEN


def test_a_skipped_sequence_number_is_a_fault_while_armed(board, rig):
    """A lost line, or a second master, shows in the sequence."""
    board.arm()
    board.ask("SET", "VOLTAGE", 3000, 3000)
    rig.await_live(True)
    assert board.ask("SET", "VOLTAGE", 4000, 4000, sequence=board.after(2)) == (
        False,
        "SEQUENCE SET VOLTAGE 4000 4000",
    )
    rig.await_live(False)
    assert board.report().fault_code == 5


def test_a_garbled_command_is_a_fault_while_armed(board, rig):
    """One flipped bit is found by the checksum, is not obeyed, and grounds."""
    board.arm()
    board.ask("SET", "VOLTAGE", 3000, 3000)
    rig.await_live(True)
    line = bytearray(wire.encode_command(board.after(1), "SET", "VOLTAGE", 3000, 3000))
    line[17] ^= 1
    board.send(bytes(line))
    assert board.reply() == (False, "CHECKSUM")
    rig.await_live(False)
    assert board.report().fault_code == 6


@pytest.mark.parametrize("text", [">002", "GET VOLTAGE", ">002" + 11 * " A", ">256 PING", ">002  "])
def test_a_line_that_is_no_command_is_a_fault_while_armed(board, rig, text):
    """A right checksum does not make a command: whoever sends this is not the driver."""
    board.arm()
    board.ask("SET", "VOLTAGE", 3000, 3000)
    rig.await_live(True)
    board.send(wire.encode(text))
    assert board.reply() == (False, "SYNTAX")
    rig.await_live(False)
    assert board.report().fault_code == 6


def test_random_bytes_neither_arm_nor_hang_the_board(board, rig):
    """After any rubbish, with and without a right checksum, the board is dead, grounded and answers."""
    generator = random.Random(1)
    for _ in range(60):
        board.send(generator.randbytes(generator.randrange(1, 150)))
        words = " ".join(generator.choices(WORDS, k=generator.randrange(12)))
        board.send(b"\n" + wire.encode(f">{generator.randrange(300):03d} {words}"))
        time.sleep(0.02)  # as long as the line needs for them
    board.send(b"\n")
    board.forget(0.5)
    assert board.ask("PING") == (True, "PING")
    assert board.report().mode is Mode.STANDBY
    assert rig.changes == []


def test_slew_is_limited(board):
    """The measured voltage rises no faster than SLEW."""
    board.ask("SET", "SLEW", 20)
    board.arm()
    board.ask("SET", "VOLTAGE", 5000, 0)
    reports = board.listen(0.4)
    rising = [(r.time_us / 1000, r.measured[0]) for r in reports if 200 < r.measured[0] < 4800]
    (first_ms, first_v), (last_ms, last_v) = rising[0], rising[-1]
    assert (last_v - first_v) / (last_ms - first_ms) == pytest.approx(20, rel=0.1)


@pytest.mark.parametrize("dead_time_ms", [2, 6])
def test_reversal_breaks_before_it_makes(firmware_rig, converse, dead_time_ms):
    """Over many reversals the firmware's pins never close two contacts, and keep the dead time between them."""
    board = converse(firmware_rig)
    board.ask("SET", "DEADTIME", dead_time_ms)
    board.arm()
    for index in range(40):
        sign = 1 if index % 2 else -1
        board.ask("SET", "VOLTAGE", sign * 1500, -sign * 1000)
        time.sleep(0.025 + 0.004 * dead_time_ms)
    board.ask("STOP")
    firmware_rig.await_live(False)
    overlaps, shortest_gap_us = firmware_rig.ask("contacts")
    assert overlaps == 0
    assert 950 * dead_time_ms < shortest_gap_us < 1000 * dead_time_ms + 3000


@pytest.mark.parametrize(
    ("shape", "polarity", "muscles"), list(zip(SHAPES, ("alternating", *POLARITIES), MUSCLES, strict=True))
)
def test_waveform_on_the_board_is_the_documented_one(board, shape, polarity, muscles):
    """Asked-for voltages in the telemetry follow the reference waveform, to its end and back to ARMED."""
    waveform = Waveform(shape, 3000, 4.0, 2, 0.8, polarity, muscles)
    words = f"WAVEFORM {shape} 3000 4000 2 800 {polarity} {muscles}"
    assert board.ask("SET", *words.split()) == (True, words)
    board.arm()
    before_us = board.report().time_us
    board.ask("START")
    reports = board.listen(waveform.duration_s + 0.3)
    assert ("WAVEFORM", "DONE") in [event.words for event in board.events]
    assert reports[-1].mode is Mode.ARMED

    def deviation(start_us: int) -> float:
        pairs = [(r.voltage, waveform.voltage((r.time_us - start_us) * 1e-6)) for r in reports]
        errors = sorted(max(abs(a - b) for a, b in zip(*pair, strict=True)) for pair in pairs)
        return errors[int(0.9 * len(errors))]  # a report at a jump may fall on either side

    # The start is known as well as this machine keeps time: it must exist, and fit all reports at once.
    assert min(deviation(before_us + 1000 * ms) for ms in range(-2, 150)) < 3000 * 0.02
    assert max(abs(v) for r in reports for v in r.voltage) > 2500


def test_telemetry_keeps_its_period_and_clock(board):
    """100 reports a second by default, stamped by the board's own clock."""
    reports = board.listen(1.0)
    periods_ms = [(b.time_us - a.time_us) / 1000 for a, b in itertools.pairwise(reports)]
    assert sum(periods_ms) / len(periods_ms) == pytest.approx(10, abs=0.5)
