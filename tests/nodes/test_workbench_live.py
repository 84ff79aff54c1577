# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The workbench on a running rig: it hears, stops, has runs made and takes them; it never arms."""

import asyncio
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hasel_bringup.processes import Processes
from hasel_interfaces.msg import SupplyState
from hasel_sim.model import load_model, save_model
from hasel_sysid.answer.next_run import Manoeuvre
from hasel_sysid.errors import SysidError
from hasel_workbench.live.rig import RunningRig
from std_srvs.srv import Trigger

_UNARMED = ("STANDBY", "FAULT")  # the latter where this machine held up the virtual board


def _until(condition: Callable[[], object], check: Callable[[], None], seconds: float = 60.0) -> None:
    end = time.monotonic() + seconds
    while not condition():
        check()
        assert time.monotonic() < end, "it did not come"
        time.sleep(0.02)


def _simulators(folder: Path) -> list[str]:
    """Processes that simulate a model of this folder."""
    found = []
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            line = path.read_bytes().replace(b"\0", b" ").decode(errors="replace")
        except OSError:  # it has ended meanwhile
            continue
        if "simulator" in line and str(folder) in line:
            found.append(line)
    return found


def _made(
    rig: RunningRig, run: Manoeuvre, call: Callable[[str], Trigger.Response]
) -> tuple[str, list[float]]:
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


def _takes_a_model(rig: RunningRig, folder: Path) -> None:
    """There being no simulator, one is started; it takes another model; one that is none of the rig's is refused."""
    file = folder / "model.yaml"
    for name, words in (("swimmer", "was started"), ("swimmer", "is simulated from now on")):
        save_model(load_model(name), file)
        assert words in rig.load(file, lambda *_: None)
        assert rig.has_simulator
    save_model(load_model("arm"), file)
    with pytest.raises(SysidError, match="pressure"):
        rig.load(file, lambda *_: None)


def _ended(rig: RunningRig, folder: Path) -> bool:
    """Whether the last run can be taken."""
    try:
        return bool(rig.recordings(folder / "heard"))
    except SysidError:
        return False


@pytest.mark.timeout(600)
def test_a_run_is_made_heard_and_stopped(tmp_path, environment, domain, listener):
    """Not armed, a run is refused; armed by the driver's own service it is made and heard; STOP is a fault."""
    rig, short = RunningRig(), Manoeuvre(3000.0, 4.0, 2, "box", "both")
    assert asyncio.run(rig.stop()) == "no rig is connected: use the mushroom switch"
    with pytest.raises(SysidError, match="no rig is heard"):
        rig.run(short, lambda *_: None)
    with Processes(tmp_path, environment) as processes:
        processes.start("hasel_bringup", "virtual_rig")
        assert rig.connect("/hasel", domain) == ""
        try:
            _until(lambda: rig.is_there and rig.stream.count["measured"] > 100, processes.check)
            assert rig.said().startswith(_UNARMED)
            assert "No simulator is heard" in rig.said()
            _takes_a_model(rig, tmp_path)
            with pytest.raises(SysidError, match=r"(?i)arm"):
                rig.run(short, lambda *_: None)
            assert rig.said().startswith(_UNARMED)

            said, shares = _made(rig, short, lambda name: listener.call(Trigger, name, 20.0, processes.check))
            assert ".mcap" in said and max(shares) > 0.2
            _until(lambda: _ended(rig, tmp_path), processes.check)
            heard = rig.recordings(tmp_path / "heard")[-1]
            assert heard.drive()[1].max() == pytest.approx(3000.0)
            assert np.nanmax(np.abs(heard.sin_theta)) > 0.02
            assert rig.stream.error.count > 20

            assert asyncio.run(rig.stop())
            _until(lambda: rig.link.state.mode == SupplyState.FAULT, processes.check)
            assert rig.said().startswith("FAULT")
        finally:
            rig.close()
        assert not _simulators(tmp_path)
