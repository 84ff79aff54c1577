# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The live simulation against the simulation of the whole run, and on bad messages."""

import numpy as np
import pytest
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.dynamics.integrator import Stepper
from hasel_sim.dynamics.time_loop import integrate
from hasel_sim.effects.base import DriveEffect, EffectParameter, ObservationEffect
from hasel_sim.effects.registry import catalogue
from hasel_sim.live.live_simulator import Arrival, LiveSimulator
from hasel_sim.model import Model, Parameter
from hasel_sim.run import Run
from hasel_sim.simulate import simulate

EPOCH_NS = 1_800_000_000_000_000_000


class LaggingSupply(DriveEffect):
    """First-order lag of the voltage: a drive effect with a memory."""

    id = "lagging_supply"
    parameters = (EffectParameter("time", "tau", "s", 0.0, 0.0, 1.0, 0.05),)

    def respond(self, time, signal, p):
        """Exact for a voltage that is constant between the instants."""
        out, value = np.empty_like(signal), np.zeros(2)
        for i, now in enumerate(time):
            if i > 0:
                value = signal[i - 1] + (value - signal[i - 1]) * np.exp(-(now - time[i - 1]) / p.time)
            out[i] = value
        return out


class CameraShift(ObservationEffect):
    """A camera whose clock is late (positive) or early."""

    id = "camera_shift"
    parameters = (EffectParameter("shift", "t", "s", 0.0, -0.1, 0.1, 0.01),)

    def look_ahead(self, p):
        """An early clock shows the future."""
        return max(0.0, -p.shift)

    def angle(self, time, sin_theta, p):
        """Linear between the instants."""
        return np.interp(time - p.shift, time, sin_theta)


def with_effect(model: Model, effect, value: float) -> Model:
    """The model with an effect of one parameter."""
    p = effect.parameters[0]
    name = f"{effect.id}.{p.name}"
    parameters = {**model.parameters, name: Parameter(name, value, p.unit, p.lower, p.upper)}
    return Model(model.description, (*model.effects, effect), parameters)


def frames(frequency: float, duration: float, sampling: float = 120.0) -> tuple[np.ndarray, np.ndarray]:
    """Stamps [ns] from an epoch as large as today's, and box voltages [V] [n, 2]."""
    time = np.arange(round(duration * sampling) + 1) / sampling
    upper = (time * frequency) % 1 < 0.5
    return EPOCH_NS + np.round(time * 1e9).astype(np.int64), 5500.0 * np.stack([upper, ~upper], axis=1)


def whole(model: Model, stamps: np.ndarray, voltage: np.ndarray) -> np.ndarray:
    """The angle series [n] from `simulate`."""
    time = (stamps - stamps[0]) * 1e-9
    return simulate(model, Run("whole", time, DriveSchedule(time, voltage))).sin_theta


def live(simulator: LiveSimulator, stamps: np.ndarray, voltage: np.ndarray) -> dict[int, float]:
    """sin theta by stamp."""
    answers = [simulator.receive(int(s), v) for s, v in zip(stamps, voltage, strict=True)]
    return {angle.stamp_ns: angle.sin_theta for answer in answers for angle in answer.angles}


@pytest.mark.parametrize(("frequency", "duration"), [(2.0, 1.0), (0.5, 2.5)])
def test_live_and_whole_run_agree(swimmer, frequency, duration):
    """While the history covers the run, both give the same numbers, sub-steps included."""
    stamps, voltage = frames(frequency, duration)
    heard = live(LiveSimulator(swimmer), stamps, voltage)
    assert list(heard) == stamps.tolist()
    difference = np.array(list(heard.values())) - whole(swimmer, stamps, voltage)
    assert np.abs(difference).max() < 1e-6
    assert max(heard.values()) > 0.3


def test_a_slow_supply_is_followed_in_sub_steps(swimmer):
    """At 50 messages a second each is bridged by several steps, as in the whole run."""
    stamps, voltage = frames(2.0, 1.0, sampling=50.0)
    heard = live(LiveSimulator(swimmer), stamps, voltage)
    assert np.abs(np.array(list(heard.values())) - whole(swimmer, stamps, voltage)).max() < 1e-6


def test_an_effect_with_memory_agrees(swimmer):
    """A lag in the supply needs the voltage's history."""
    model = with_effect(swimmer, LaggingSupply(), 0.08)
    stamps, voltage = frames(2.0, 0.6)
    heard = np.array(list(live(LiveSimulator(model), stamps, voltage).values()))
    assert np.abs(heard - whole(model, stamps, voltage)).max() < 1e-6
    assert np.abs(heard - whole(swimmer, stamps, voltage)).max() > 1e-2


def test_a_history_that_outlasts_the_lag_is_enough(swimmer):
    """In a run longer than the history, a lag much shorter than it is still right."""
    model = with_effect(swimmer, LaggingSupply(), 0.02)
    stamps, voltage = frames(2.0, 2.0)
    heard = np.array(list(live(LiveSimulator(model, history=1.0), stamps, voltage).values()))
    assert np.abs(heard - whole(model, stamps, voltage)).max() < 1e-6


def test_the_start_of_the_run_is_not_forgotten(swimmer):
    """A drift counts from the start however short the history is."""
    model = swimmer.with_effects("gain_drift").with_values({"gain_drift.rate": 0.2})
    stamps, voltage = frames(2.0, 2.0)
    heard = np.array(list(live(LiveSimulator(model, history=1.0), stamps, voltage).values()))
    assert np.abs(heard - whole(model, stamps, voltage)).max() < 1e-6
    assert np.abs(heard - whole(swimmer, stamps, voltage)).max() > 1e-2


@pytest.mark.parametrize(("shift", "untold"), [(0.02, 0), (-0.02, 3)])
def test_a_shifted_camera_agrees_once_it_can_be_known(swimmer, shift, untold):
    """A late clock looks back; an early one delays the answer by its advance."""
    model = with_effect(swimmer, CameraShift(), shift)
    stamps, voltage = frames(2.0, 0.5)
    heard = live(LiveSimulator(model), stamps, voltage)
    assert list(heard) == stamps[: len(stamps) - untold].tolist()
    expected = whole(model, stamps, voltage)[: len(heard)]
    assert np.abs(np.array(list(heard.values())) - expected).max() < 1e-6


def test_the_catalogues_camera_agrees_from_the_first_frame(swimmer):
    """Its spline needs more than the one instant that is known at first."""
    model = swimmer.with_effects("camera_latency").with_values({"camera_latency.latency": 0.03})
    stamps, voltage = frames(2.0, 0.5)
    heard = live(LiveSimulator(model), stamps, voltage)
    expected = whole(model, stamps, voltage)[: len(heard)]
    assert len(heard) == len(stamps)
    assert np.abs(np.array(list(heard.values())) - expected).max() < 1e-4


def test_a_body_at_rest_is_not_stepped_until_the_drive_changes(swimmer, monkeypatch):
    """Nothing moved for as long as anything is remembered, so nothing will; then it moves as in the whole run."""
    stamps, voltage = frames(2.0, 2.0)
    voltage[: len(voltage) * 3 // 4] = 0.0
    steps = []
    follow = Stepper.follow
    monkeypatch.setattr(Stepper, "follow", lambda *given: steps.append(given) or follow(*given))
    heard = live(LiveSimulator(swimmer, history=0.5), stamps, voltage)
    every = swimmer.description.numerics.steps_per_second * 2.0
    assert 0.45 < len(steps) / every < 0.55  # 0.5 s until it is at rest, and 0.5 s driven
    assert np.abs(np.array(list(heard.values())) - whole(swimmer, stamps, voltage)).max() < 1e-6
    assert max(heard.values()) > 0.1


def test_a_live_body_steps_in_the_loops_that_runs_have_compiled(swimmer):
    """Whoever starts a rig for the first time does not wait for another compilation of them."""
    stamps, voltage = frames(2.0, 0.1)
    whole(swimmer, stamps, voltage)
    known = list(integrate.signatures)
    live(LiveSimulator(swimmer), stamps, voltage)
    assert integrate.signatures == known


def test_messages_out_of_order_leave_the_motion_alone(swimmer):
    """Late and repeated messages are answered by a sentence, and the rest of the run is as without them."""
    stamps, voltage = frames(2.0, 0.4)
    disturbed, answers = LiveSimulator(swimmer), []
    for index, (stamp, row) in enumerate(zip(stamps, voltage, strict=True)):
        answers.append(disturbed.receive(int(stamp), row))
        if index % 7 == 3:
            answers.append(disturbed.receive(int(stamp), -row))
            answers.append(disturbed.receive(int(stamps[index - 2]), -row))
    held = [answer for answer in answers if answer.arrival == Arrival.HELD]
    assert len(held) == 14
    assert all(answer.sentence and not answer.angles for answer in held)
    heard = [angle.sin_theta for answer in answers for angle in answer.angles]
    assert heard == list(live(LiveSimulator(swimmer), stamps, voltage).values())


def test_a_gap_is_bridged_under_the_voltage_held(swimmer):
    """Missing messages in the middle of a hold change nothing, but are said."""
    stamps, voltage = frames(0.5, 0.8)
    kept = np.r_[0:30, 60 : len(stamps)]
    simulator = LiveSimulator(swimmer)
    answers = [simulator.receive(int(stamps[i]), voltage[i]) for i in kept]
    assert [a.arrival for a in answers].count(Arrival.GAP) == 1
    heard = np.array([angle.sin_theta for answer in answers for angle in answer.angles])
    assert np.abs(heard - whole(swimmer, stamps, voltage)[kept]).max() < 1e-6


def test_an_unknown_voltage_leaves_the_last_in_force(swimmer):
    """A supply that is not connected says NaN; the body moves on, and it is said."""
    stamps, voltage = frames(0.5, 0.5)
    unknown = voltage.copy()
    unknown[20:30] = np.nan
    simulator = LiveSimulator(swimmer)
    answers = [simulator.receive(int(s), v) for s, v in zip(stamps, unknown, strict=True)]
    assert sum("does not know" in answer.sentence for answer in answers) == 10
    heard = [angle.sin_theta for answer in answers for angle in answer.angles]
    assert heard == list(live(LiveSimulator(swimmer), stamps, voltage).values())


def test_a_run_may_start_with_an_unknown_voltage(swimmer):
    """A driver in FAULT at the start says NaN: 0 V until more is known, with every drive effect, and it is said."""
    drive = [effect.id for effect in catalogue().values() if isinstance(effect, DriveEffect)]
    stamps, voltage = frames(2.0, 0.2)
    unknown, still = voltage.copy(), voltage.copy()
    unknown[:3], still[:3] = np.nan, 0.0
    for effects in ((), tuple(drive)):
        model = swimmer.with_effects(*effects)
        simulator = LiveSimulator(model)
        answers = [simulator.receive(int(s), v) for s, v in zip(stamps, unknown, strict=True)]
        assert ["0 V before any is known" in answer.sentence for answer in answers[:4]] == [True] * 3 + [
            False
        ]
        heard = [angle.sin_theta for answer in answers for angle in answer.angles]
        assert heard == list(live(LiveSimulator(model), stamps, still).values())


def test_a_long_gap_starts_from_rest(swimmer):
    """After a jump in the stamps the angles are those of a fresh run."""
    stamps, voltage = frames(2.0, 0.3)
    simulator = LiveSimulator(swimmer)
    live(simulator, stamps, voltage)
    again = live(simulator, stamps + 60_000_000_000, voltage)
    assert list(again.values()) == list(live(LiveSimulator(swimmer), stamps, voltage).values())


def test_a_motion_that_cannot_be_followed_is_said_and_starts_anew(swimmer):
    """Absurd amplitudes end in a sentence, not in a crash, and the next message starts from rest."""
    wild = swimmer.with_values({"amplitude_5500": 0.6, "slope": 50.0}).with_numerics(steps_per_second=5.0)
    stamps, voltage = frames(2.0, 2.0, sampling=5.0)
    simulator = LiveSimulator(wild, gap=1.0)
    answers = [simulator.receive(int(s), 10 * v) for s, v in zip(stamps, voltage, strict=True)]
    failed = [answer for answer in answers if "starts from rest" in answer.sentence]
    assert failed
    assert answers[answers.index(failed[0]) + 1].arrival == Arrival.START


def test_two_stamps_that_nearly_coincide_do_not_end_the_motion(swimmer):
    """Two clocks meet now and then; a step of some nanoseconds says nothing of the acceleration."""
    stamps, voltage = frames(2.0, 0.5)
    simulator, twice = LiveSimulator(swimmer), LiveSimulator(swimmer)
    heard = list(live(simulator, stamps, voltage).values())
    sines, sentences = [], []
    for stamp, each in zip(stamps, voltage, strict=True):
        answers = [twice.receive(int(stamp) + later, each) for later in (0, 10)]
        sines.append(answers[0].angles[-1].sin_theta)
        sentences += [answer.sentence for answer in answers]
    assert not any(sentences)
    assert np.abs(np.array(sines) - heard).max() < 1e-5


def test_another_model_of_the_same_body_goes_on_in_the_present_motion(swimmer):
    """Adding an effect at run time does not make the body jump, and acts from then on."""
    stamps, voltage = frames(2.0, 1.0)
    changed, simulator = with_effect(swimmer, LaggingSupply(), 0.1), LiveSimulator(swimmer)
    half = len(stamps) // 2
    before = live(simulator, stamps[:half], voltage[:half])
    simulator.use(changed)
    after = live(simulator, stamps[half:], voltage[half:])
    alone = np.array(list(live(LiveSimulator(swimmer), stamps, voltage).values()))
    together = np.array([*before.values(), *after.values()])
    assert np.array_equal(together[:half], alone[:half])
    assert np.abs(np.diff(together)).max() < 2 * np.abs(np.diff(alone)).max()
    assert np.abs(together - alone).max() > 1e-2


def test_another_body_starts_from_rest(swimmer, rectangle):
    """The positions of one mesh mean nothing on another."""
    stamps, voltage = frames(2.0, 0.1)
    simulator = LiveSimulator(swimmer)
    live(simulator, stamps, voltage)
    simulator.use(rectangle())
    assert simulator.receive(int(stamps[-1]) + 1, voltage[0]).arrival == Arrival.START
    assert simulator.position.shape == simulator.mesh.nodes.shape


def test_a_released_beam_swings(rectangle):
    """With a load factor of 0 the beam starts straight and falls under its weight."""
    simulator = LiveSimulator(rectangle(gravity=9.81), load_factor=0.0)
    stamps, _ = frames(2.0, 0.2)
    heard = list(live(simulator, stamps, np.zeros((len(stamps), 2))).values())
    assert heard[0] == pytest.approx(0.0, abs=1e-9)
    assert min(heard) < -0.01
