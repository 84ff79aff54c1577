# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Hardware that does not do as it is told: found within half a second, never called grounded, on both supplies."""

import time

import pytest
from hasel_driver.protocol.faults import FaultCode, RefusedError
from hasel_driver.protocol.status import Ground, Mode
from hasel_driver.testing.kinds import KINDS, UNSEEN, try_kind
from hasel_driver.testing.rig import Bench
from hasel_driver.testing.walk import Walk

ALL = [*KINDS, *UNSEEN]


@pytest.mark.parametrize("kind", ALL, ids=lambda kind: kind.name)
@pytest.mark.rounds(1, 16)
def test_a_kind_is_found_and_nothing_untrue_is_said(bench, request, kind, rounds):
    """Truth is what the simulated contacts and muscles have, never the driver's word; each channel in its turn."""
    if kind.virtual_only and "firmware" in request.node.name:
        pytest.skip("the firmware's monitor has no sign")
    first = ALL.index(kind)
    for number in range(first, first + rounds):
        assert try_kind(bench, kind, number % 2).wrong == []


@pytest.mark.parametrize("how", ["weld", "unground"])
def test_a_failed_contact_stays_failed(rig, how):
    """When the muscle has leaked empty, the port is opened anew, the board is reset: only a proof clears it."""
    bench = Bench(rig)
    try:
        bench.arm()
        assert bench.command_until(lambda: bench.status().measured_v[0] > 2500)
        rig.say(how)
        bench.call(bench.supervisor.disarm)
        assert bench.wait_until(lambda: bench.supervisor.fault is not None)
        rig.say("leak")  # 50 ms
        assert bench.wait_until(lambda: bench.status().ground is Ground.COMMANDED)
        with pytest.raises(RefusedError, match="came back"):
            bench.call(bench.supervisor.clear_fault)
    finally:
        bench.close()
    rig.say("reset")
    time.sleep(0.3)
    rig.say("recover")  # mended, which only a pulse would show
    again = Bench(rig)  # a node that knows nothing of it
    try:
        assert again.supervisor.fault.code is FaultCode.NOT_GROUNDED
        assert again.status().ground is Ground.COMMANDED  # no pulse yet: hands may be at the contacts
        assert again.wait_until(lambda: again.status().quiet)
        again.call(again.supervisor.clear_fault)
        again.await_mode(Mode.STANDBY)
        assert again.status().ground is Ground.PROVEN
    finally:
        again.close()


def test_standby_before_any_proof_is_not_called_grounded(bench):
    """Contacts that are commanded, and a monitor that reads little, are no proof; arming is one."""
    bench.await_mode(Mode.STANDBY)
    assert (bench.status().ground, bench.status().output) == (Ground.COMMANDED, "commanded")
    bench.arm()
    assert bench.status().output == "grounded"


def test_a_channel_of_the_interlock_alone_stays_latched(bench):
    """Neither a re-opened port nor a reset forgets it; both open together does."""
    bench.arm()
    bench.rig.say("interlock_a")
    assert bench.wait_until(lambda: bench.supervisor.fault is not None)
    assert bench.supervisor.fault.code in (FaultCode.INTERLOCK, FaultCode.DISCREPANCY)
    with pytest.raises(RefusedError, match="interlock is open"):
        bench.call(bench.supervisor.clear_fault)
    time.sleep(0.7)
    bench.rig.say("recover")
    time.sleep(0.1)
    with pytest.raises(RefusedError, match="disagreed"):
        bench.call(bench.supervisor.clear_fault)
    bench.rig.say("interlock")
    time.sleep(0.1)
    bench.rig.say("recover")
    time.sleep(0.1)
    bench.call(bench.supervisor.clear_fault)
    bench.await_mode(Mode.STANDBY)


def test_a_damaged_calibration_is_said_and_forbids_arming(rig, converse):
    """Found at the next reset; stored again, the board may be armed."""
    board = converse(rig)
    board.ask("SET", "CALIBRATION", "upper", 10100, 0, 10000, 0)
    rig.say("damage")
    board.events.clear()
    rig.say("reset")
    board.await_boot()
    assert board.report().fault_code == FaultCode.EEPROM
    board.ask("SET", "MAXIMUM", 6000)
    assert board.ask("CLEAR") == (False, "EEPROM CLEAR")
    assert board.ask("ARM") == (False, "STATE ARM")
    assert board.ask("SET", "CALIBRATION", "upper", 10000, 0, 10000, 0)[0]
    assert board.ask("CLEAR") == (True, "CLEAR")
    board.arm()


@pytest.mark.parametrize("how", ["weld", "unground"])
def test_auxiliary_contacts_are_read_where_they_are_wired(rig, converse, how):
    """What they say proves, and what they deny is a fault, whatever is measured."""
    board = converse(rig)
    assert board.ask("SET", "CONTACTS", 1) == (True, "CONTACTS 1")
    assert board.report().ground is Ground.PROVEN
    rig.say(how)
    board.listen(0.2)
    report = board.report()
    assert (report.ground, report.fault_code) == (Ground.NOT, FaultCode.NOT_GROUNDED)


@pytest.mark.rounds(12, 240)
def test_a_random_walk_says_nothing_untrue_and_leaves_nothing_live(bench, rounds):
    """No word of grounded above 200 V; nothing live half a second after a stop's last chance. `rounds`: seconds."""
    walk = Walk(bench, seed=rounds)
    walk.run(float(rounds))
    assert walk.live > 0.05 * walk.looks  # or nothing would be tried
    assert walk.wrong == [], "\n".join(walk.log)
