"""A proof of ground that fails says whether it saw a load, and says nothing of one that it saw."""

import re

import pytest
from hasel_driver.errors import RefusedError
from hasel_driver.faults import FaultCode
from hasel_driver.ground import Ground
from hasel_driver.testing.bench import Bench
from hasel_driver.testing.hooks import PUNCTUALITY
from hasel_driver.testing.rig import VIRTUAL_SUPPLY, Rig

NO_MUSCLE_NF = "0.001"


@pytest.fixture
def bare_rig(rig_command):
    """A supply of each kind with nothing but its own leads on the output."""
    option = ["--capacitance-nf"] if rig_command == VIRTUAL_SUPPLY else []
    rig = Rig([*rig_command, *option, NO_MUSCLE_NF], PUNCTUALITY.note)
    yield rig
    rig.close()


def test_where_no_muscle_is_connected_the_fault_says_so(bare_rig):
    """At arming, and at each clearing that fails; proven it is not, and that is not said."""
    bench = Bench(bare_rig)
    try:
        bench.call(bench.supervisor.arm)
        assert bench.wait_until(lambda: bench.supervisor.fault is not None)
        told = r"saw no load \(upper at most .* µA, lower at most .* µA\): look for a muscle that is not connected"
        assert bench.supervisor.fault.code is FaultCode.NOT_GROUNDED
        assert re.search(told, str(bench.supervisor.fault))
        with pytest.raises(RefusedError, match=told):
            bench.call(bench.supervisor.clear_fault)
        assert Ground.PROVEN not in {status.ground for status in bench.statuses}
    finally:
        bench.close()


def test_where_a_contact_fails_on_a_muscle_nothing_is_said_of_the_load(bench):
    """The muscle drew its current."""
    bench.rig.say("unground")
    bench.call(bench.supervisor.arm)
    assert bench.wait_until(lambda: bench.supervisor.fault is not None)
    assert bench.supervisor.fault.code is FaultCode.NOT_GROUNDED
    assert "no load" not in str(bench.supervisor.fault)
