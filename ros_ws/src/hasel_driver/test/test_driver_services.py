# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The supply's state as a message."""

import numpy as np
from hasel_common.diagnostics import Level
from hasel_driver.nodes.driver_services import supply_health, to_supply_state
from hasel_driver.nodes.experiment_goal import PRESETS
from hasel_driver.protocol.faults import FaultCode
from hasel_driver.protocol.status import UNKNOWN, Ground, Mode, SupplyStatus
from hasel_driver.protocol.waveform import MUSCLES, POLARITIES, SHAPES
from hasel_interfaces.action import RunExperiment
from hasel_interfaces.msg import SupplyState


def constants(kind: type, prefix: str = "") -> dict:
    """The constants of a message whose names begin with a prefix, without it."""
    names = [name for name in vars(type(kind)) if name.isupper() and "__" not in name and name[0] != "_"]
    return {name.removeprefix(prefix): getattr(kind, name) for name in names if name.startswith(prefix)}


def test_constants_are_those_of_the_driver():
    """Whoever hears a fault or a mode finds its name in the message."""
    assert constants(SupplyState, "FAULT_") == {code.name: code.value for code in FaultCode}
    assert {mode.name: getattr(SupplyState, mode.name) for mode in Mode} == {m.name: m.value for m in Mode}
    assert constants(SupplyState, "GROUND_") == {each.name: each.value for each in Ground}


def test_words_of_an_experiment_are_those_that_it_takes():
    """Every constant of the goal is a word of waveform, polarity, muscles or preset, and the other way round."""
    words = list(constants(RunExperiment.Goal).values())
    assert sorted(words) == sorted([*SHAPES, *POLARITIES, *MUSCLES, *PRESETS])


def test_state_names_muscles_and_frame():
    """One voltage and one current for each muscle, in a named frame."""
    status = SupplyStatus(0.0, Mode.ARMED, None, Ground.PROVEN, (1.0, -2.0), (3.0, 4.0), (0.0, 0.0))
    message = to_supply_state(status, frame_id="rig_1/supply")
    assert message.header.frame_id == "rig_1/supply"
    assert message.muscle == ["upper", "lower"]
    assert list(message.commanded_voltage) == [1.0, -2.0]
    assert np.size(message.current) == len(message.muscle)


def test_a_supply_that_is_silent_at_rest_is_a_warning():
    """In the diagnostics, with the time; the state claims nothing of its output."""
    status = SupplyStatus(0.0, Mode.STANDBY, None, None, UNKNOWN, UNKNOWN, UNKNOWN, silent_s=1.2)
    level, sentence, _ = supply_health(status)
    assert (level, sentence) == (Level.WARN, "STANDBY, output unknown, no report for 1.2 s")
    assert (to_supply_state(status).grounded, to_supply_state(status).ground) == (False, Ground.NOT)
