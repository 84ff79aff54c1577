# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Faults that a restarted node must still have."""

import pytest
from hasel_driver.protocol.faults import LATCHED_FILE, Fault, FaultCode, FaultStore, PortError

STOP, LOST = Fault(FaultCode.EMERGENCY_STOP, "by service"), Fault(FaultCode.LINK_LOST)


def test_a_stop_is_kept_for_its_port_until_it_is_cleared(tmp_path):
    """Another port's entry stays; a fault that a new connection settles by itself is not kept."""
    first, second = (FaultStore(str(tmp_path), port) for port in ("/dev/a", "/dev/b"))
    first.keep(STOP)
    second.keep(LOST)
    assert FaultStore(str(tmp_path), "/dev/a").load() == STOP
    assert FaultStore(str(tmp_path), "/dev/b").load() is None
    first.keep(None)
    assert FaultStore(str(tmp_path), "/dev/a").load() is None


def test_a_stop_beside_a_fault_is_kept_with_it(tmp_path):
    """Both are there after a restart."""
    both = Fault(FaultCode.NOT_GROUNDED, "2900 and 0 V").beside(STOP)
    FaultStore(str(tmp_path), "/dev/a").keep(both)
    assert FaultStore(str(tmp_path), "/dev/a").load() == both


@pytest.mark.parametrize(
    "text", ["{", "[]", '{"/dev/a": {"code": "stop"}}', '{"/dev/a": {"code": 9999, "detail": ""}}']
)
def test_a_file_that_makes_no_sense_is_said(tmp_path, text):
    """Nobody knows then whether there was a fault: the port is not opened."""
    (tmp_path / LATCHED_FILE).write_text(text)
    with pytest.raises(PortError, match="see to the supply"):
        FaultStore(str(tmp_path), "/dev/a").load()


def test_an_empty_folder_keeps_nothing():
    """As the parameter says."""
    store = FaultStore("", "/dev/a")
    store.keep(STOP)
    assert store.load() is None
