"""The workbench on a running rig: it hears, stops, has runs made and takes them; it never arms."""

import asyncio
import time
from collections.abc import Callable

import numpy as np
import pytest
from hasel_bringup.demo.processes import Processes
from hasel_interfaces.msg import SupplyState
from hasel_sysid.errors import SysidError
from hasel_sysid.suggest import Manoeuvre
from hasel_sysid.workbench.live.rig import Rig
from std_srvs.srv import Trigger


def _until(condition: Callable[[], object], check: Callable[[], None], seconds: float = 60.0) -> None:
    end = time.monotonic() + seconds
    while not condition():
        check()
        assert time.monotonic() < end, "it did not come"
        time.sleep(0.02)


def _made(rig: Rig, run: Manoeuvre, call: Callable[[str], Trigger.Response]) -> tuple[str, list[float]]:
    """What is said of a run and how far it had come; made again where this machine holds up the virtual board."""
    for _ in range(8):
        shares: list[float] = []
        call("/hasel/clear_fault")
        if not call("/hasel/arm").success:
            time.sleep(1.0)
            continue
        try:
            return rig.run(run, lambda _, share, shares=shares: shares.append(share)), shares
        except SysidError as error:
            assert "the run failed" in str(error) or "arm" in str(error)
    pytest.skip("this machine is too busy for a virtual board: it stopped itself in every run")


@pytest.mark.timeout(300)
def test_a_run_is_made_heard_and_stopped(tmp_path, environment, domain, listener):
    """Not armed, a run is refused; armed by the driver's own service it is made and heard; STOP is a fault."""
    rig, short = Rig(), Manoeuvre(3000.0, 4.0, 2, "box", "both")
    assert asyncio.run(rig.stop()) == "no rig is connected: use the mushroom switch"
    with pytest.raises(SysidError, match="no rig is heard"):
        rig.run(short, lambda *_: None)
    with Processes(tmp_path, environment) as processes:
        processes.start("hasel_bringup", "virtual_rig")
        assert rig.connect("/hasel", domain) == ""
        try:
            _until(lambda: rig.is_there and rig.stream.count["measured"] > 100, processes.check)
            assert rig.said().startswith("STANDBY")
            with pytest.raises(SysidError, match=r"(?i)arm"):
                rig.run(short, lambda *_: None)
            assert rig.link.state.mode == SupplyState.STANDBY

            said, shares = _made(rig, short, lambda name: listener.call(Trigger, name, 20.0, processes.check))
            assert ".mcap" in said and max(shares) > 0.2
            heard = rig.stream.recordings(tmp_path / "heard")[-1]
            assert heard.drive()[1].max() == pytest.approx(3000.0)
            assert np.nanmax(np.abs(heard.sin_theta)) > 0.02

            assert asyncio.run(rig.stop())
            _until(lambda: rig.link.state.mode == SupplyState.FAULT, processes.check)
            assert rig.said().startswith("FAULT")
        finally:
            rig.close()
