"""A simulator of the workbench's own, where the rig has none."""

import time

import pytest
from hasel_sysid.errors import SysidError
from hasel_workbench.live.simulator import OwnSimulator


def test_its_last_words_are_told(tmp_path):
    """A model that it cannot simulate ends it; what it said is in a file, and nothing is left to end."""
    model = tmp_path / "broken.yaml"
    model.write_text("name: broken\n")
    simulator = OwnSimulator("/hasel")
    simulator.check()
    simulator.start(model)
    end = time.monotonic() + 100.0
    try:
        with pytest.raises(SysidError, match=r"the simulator that was started has ended: error: .*broken"):
            while time.monotonic() < end:
                simulator.check()
                time.sleep(0.05)
    finally:
        simulator.close()
    assert "broken" in (tmp_path / "simulator.log").read_text()
    simulator.check()
