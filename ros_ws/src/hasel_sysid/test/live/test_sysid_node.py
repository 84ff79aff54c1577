# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The identification as a node on real DDS, in this process."""

import signal
import sys
import threading
import time
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from hasel_common.endpoints import Role
from hasel_common.managed_node import ManagedNode
from hasel_common.node_process import run_node
from hasel_common.progress import Stage
from hasel_common.topics import MEASURED, SIMULATED, STATE
from hasel_interfaces.msg import BendingAngle, Fit, RunningError, SupplyState
from hasel_interfaces.srv import Diagnose, FitModel
from hasel_recording import Recording
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.errors import HaselSimError
from hasel_sim.live.simulator_interface import angle_message, to_nanoseconds, to_time
from hasel_sim.model import load_model, save_model
from hasel_sim.run import Run
from hasel_sim.simulate import simulate
from hasel_sysid.errors import SysidError
from hasel_sysid.live import sysid_node
from hasel_sysid.live.sysid_node import SysidNode
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.parameter import Parameter

TRUTH = {"amplitude_5500": 0.06, "slope": 0.8}


@pytest.fixture
def swimmer():
    """The default swimmer at one voltage."""
    return load_model("swimmer").with_levels(np.array([5500.0]))


@pytest.fixture
def recording(swimmer) -> Recording:
    """What the model does with the true values, half a second long."""
    time_s = np.arange(61) / 120
    upper = (time_s * 4) % 1 < 0.5
    voltage = 5500.0 * np.stack([upper, ~upper], axis=1)
    run = Run("truth", time_s, DriveSchedule(time_s, voltage))
    return Recording("truth", time_s, simulate(swimmer.with_values(TRUTH), run).sin_theta, voltage)


@pytest.fixture
def talk(tmp_path, swimmer):
    """The node, spun in a thread, and a second node that talks to it."""
    start = swimmer.with_values({"amplitude_5500": 0.04, "slope": 0.5})
    save_model(start, tmp_path / "start.yaml")
    given = (f"model:={tmp_path}/start.yaml", f"output:={tmp_path}", f"own_files:={tmp_path}/own", "jobs:=1")
    rclpy.init(args=["--ros-args", *(word for each in given for word in ("-p", each))])
    node, user = SysidNode(), rclpy.create_node("user")
    node.begin()
    executor = MultiThreadedExecutor(num_threads=3)
    executor.add_node(node)
    thread = threading.Thread(target=executor.spin, daemon=True)
    thread.start()
    yield Talk(user, node)
    executor.shutdown()
    thread.join(timeout=10)
    node.destroy_node()
    user.destroy_node()
    rclpy.try_shutdown()


class Talk:
    """Publishes the three topics and listens to what the node says."""

    def __init__(self, user, node: SysidNode) -> None:
        self.user, self.node, self.errors, self.fits = user, node, [], []
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(user)
        self.states = user.create_publisher(SupplyState, STATE, Role.EVERY_SAMPLE.value)
        self.measured = user.create_publisher(BendingAngle, MEASURED, Role.EVERY_SAMPLE.value)
        self.simulated = user.create_publisher(BendingAngle, SIMULATED, Role.EVERY_SAMPLE.value)
        user.create_subscription(RunningError, "/hasel/error", self.errors.append, Role.EVERY_SAMPLE.value)
        user.create_subscription(Fit, "/hasel/fit", self.fits.append, Role.RESULTS.value)
        publishers = (self.states, self.measured, self.simulated)
        self.until(
            lambda: (
                all(p.get_subscription_count() for p in publishers)
                and user.count_publishers("/hasel/error")
                and user.count_publishers("/hasel/fit")
            )
        )

    def until(self, condition, seconds: float = 180.0) -> None:
        """Spin until something is true."""
        end = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < end, "waited too long"
            self.executor.spin_once(timeout_sec=0.05)

    def say(self, recording: Recording, simulated: np.ndarray) -> None:
        """Publish a recording and simulated angles at its frames."""
        stamps = np.round(recording.time_s * 1e9).astype(int).tolist()
        for stamp, voltage, measured, sine in zip(
            stamps, recording.voltage.tolist(), recording.sin_theta.tolist(), simulated.tolist(), strict=True
        ):
            state = SupplyState(commanded_voltage=voltage)
            state.header.stamp = to_time(stamp)
            self.states.publish(state)
            self.measured.publish(angle_message(stamp, measured, "camera"))
            self.simulated.publish(angle_message(stamp, sine, "swimmer"))

    def fit(self, **request):
        """Ask for a fit; returns the future of its answer."""
        self.client = self.user.create_client(FitModel, "/hasel/fit")
        assert self.client.wait_for_service(timeout_sec=10.0)
        return self.client.call_async(FitModel.Request(**request))


@pytest.mark.parametrize(
    ("given", "nearest"), [("model:=swimer", "swimmer"), ("effects:=['quadratic_darg']", "quadratic_drag")]
)
def test_a_misspelt_model_or_effect_ends_the_node(given, nearest, capsys):
    """In the sentence of the simulator, and not when the first fit is asked for."""
    usual, arguments = signal.getsignal(signal.SIGINT), sys.argv
    try:
        sys.argv = ["sysid", "--ros-args", "-p", given]
        assert run_node(SysidNode, ManagedNode.begin, errors=(HaselSimError,)) == 1
    finally:
        sys.argv = arguments
        signal.signal(signal.SIGINT, usual)
    assert f"the nearest known one is '{nearest}'" in capsys.readouterr().err


def test_no_request_brings_code_with_it(talk, tmp_path):
    """An effect's file lies below the folder given at the start, and what was given then stays."""
    file = tmp_path / "effect.py"
    file.write_text("raise SystemExit('it ran')")
    client = talk.user.create_client(Diagnose, "/hasel/diagnose")
    assert client.wait_for_service(timeout_sec=10.0)
    future = client.call_async(Diagnose.Request(effects=[f"{file}:Effect"]))
    talk.until(future.done)
    assert not future.result().success
    assert f"is no file below {tmp_path}/own" in future.result().message
    for name, value in (("effects", [f"{file}:Effect"]), ("model", str(file)), ("output", "/etc")):
        (result,) = talk.node.set_parameters([Parameter(name, value=value)])
        assert not result.successful


def test_the_error_is_published_for_every_frame(talk, recording):
    """With the run's mean difference taken out, at the frames' stamps."""
    simulated = recording.sin_theta + 0.5 + 0.01 * np.sin(50 * recording.time_s)
    talk.say(recording, simulated)
    talk.until(lambda: len(talk.errors) == 61)
    difference = simulated - recording.sin_theta
    assert [e.difference for e in talk.errors] == pytest.approx(difference.tolist())
    expected = np.abs(difference - difference.mean()).mean()
    assert talk.errors[-1].mean_absolute_error == pytest.approx(expected)
    assert [to_nanoseconds(e.header.stamp) for e in talk.errors][-1] == 500_000_000
    assert talk.errors[-1].count == 61


def test_rest_does_not_make_the_published_error_smaller(talk):
    """Half a second of drive, then ten of rest: the error is that of the run and of the second after it."""
    time_s = np.arange(1260) / 120
    driven = time_s < 0.5
    measured = 0.1 * np.sin(50 * time_s) * driven
    voltage = np.stack([4500.0 * driven, np.zeros(len(time_s))], axis=1)
    talk.say(Recording("rests", time_s, measured, voltage), 1.2 * measured)
    talk.until(lambda: len(talk.errors) == len(time_s))
    last, of_the_run = talk.errors[-1], time_s <= 1.5
    assert last.count == of_the_run.sum()
    difference = 0.2 * measured[of_the_run]
    assert last.mean_absolute_error == pytest.approx(np.abs(difference - difference.mean()).mean())
    assert last.difference == 0.0


@pytest.fixture
def held_fit(monkeypatch):
    """The events that a fit has `begun`, and that it may be `answered`; until then it is held back."""
    events = SimpleNamespace(begun=threading.Event(), answered=threading.Event())
    fit = sysid_node.fit_recordings

    def held_back(*arguments):
        events.begun.set()
        result = fit(*arguments)
        events.answered.wait(60.0)
        return result

    monkeypatch.setattr(sysid_node, "fit_recordings", held_back)
    yield events
    events.answered.set()


def test_what_was_heard_is_fitted_while_the_node_goes_on(talk, recording, held_fit):
    """The truth is found, published and written; meanwhile errors are still summed up and a second fit is refused."""
    talk.say(recording, recording.sin_theta)
    talk.until(lambda: len(talk.errors) == 61)
    answer = talk.fit()
    talk.until(held_fit.begun.is_set)
    second = talk.fit()
    talk.say(recording, recording.sin_theta)
    talk.until(lambda: len(talk.errors) == 122)
    talk.until(second.done)
    assert (second.result().success, "busy" in second.result().message) == (False, True)
    assert not answer.done()
    held_fit.answered.set()
    talk.until(lambda: answer.done() and talk.fits)
    assert answer.result().success, answer.result().message
    found = {p.name: p.value for p in talk.fits[0].parameters}
    assert found == pytest.approx(TRUTH, rel=1e-3)
    assert load_model(talk.fits[0].model).values == pytest.approx(found)
    assert talk.fits[0].mean_absolute_error < 1e-4


def test_diagnostics_tell_how_far_a_fit_is(talk, recording, held_fit, monkeypatch):
    """Stage, how many of how many, share and time left, in the sentence and as values of their own."""

    def half_way(_model, _recordings, _method, _jobs, workload):
        fit = Stage("fit", 10.0, known=True)
        workload.expect([fit])
        with workload.stage(fit):
            for _ in range(5):
                workload.did()
            held_fit.answered.wait(60.0)
        raise SysidError("it was only looked at")

    monkeypatch.setattr(sysid_node, "fit_recordings", half_way)
    entries = []
    talk.user.create_subscription(
        DiagnosticArray, "/diagnostics", lambda array: entries.extend(array.status), 10
    )
    talk.say(recording, recording.sin_theta)
    talk.until(lambda: len(talk.errors) == 61)
    answer = talk.fit()

    def told() -> list[dict[str, str]]:
        every = [({v.key: v.value for v in entry.values}, entry.message) for entry in entries]
        return [{**values, "message": said} for values, said in every if "simulations" in said]

    talk.until(told)
    held_fit.answered.set()
    talk.until(answer.done)
    now = told()[-1]
    assert now["message"].startswith("fit, 5 of 10 simulations, about 0:00:0")
    assert (now["stage"], now["simulations done"], now["simulations expected"]) == ("fit", "5", "10")
    assert float(now["share"]) == 0.5
    assert float(now["time left [s]"]) >= 0.0
    entries.clear()
    talk.until(lambda: entries)
    assert "stage" not in {v.key for v in entries[-1].values}


def test_a_missing_effect_is_named(talk, swimmer, recording):
    """Of two candidates the one that acts in the run, with its verdict, value and unit."""
    hidden = swimmer.with_effects("quadratic_drag").with_values({**TRUTH, "quadratic_drag.coefficient": 0.05})
    run = Run("truth", recording.time_s, DriveSchedule(recording.time_s, recording.voltage))
    noise = 1e-4 * np.random.default_rng(5).standard_normal(len(recording.time_s))
    measured = replace(recording, sin_theta=simulate(hidden, run).sin_theta + noise)
    talk.say(measured, recording.sin_theta)
    talk.until(lambda: len(talk.errors) == 61)
    client = talk.user.create_client(Diagnose, "/hasel/diagnose")
    assert client.wait_for_service(timeout_sec=10.0)
    future = client.call_async(Diagnose.Request(effects=["quadratic_drag", "gain_drift"]))
    talk.until(future.done)
    answer = future.result()
    assert answer.success, answer.message
    first = answer.diagnosis.ranking[0]
    assert (first.effect, answer.diagnosis.status) == ("quadratic_drag", "explained")
    assert answer.diagnosis.missing == ["quadratic_drag"]
    assert first.parameters[0].value == pytest.approx(0.05, rel=0.1)
    assert answer.diagnosis.noise_floor == pytest.approx(0.8e-4, rel=0.5)


def test_a_mistaken_request_is_answered_by_a_sentence(talk):
    """Nothing heard, no such file, an unknown method."""
    for request, words in (
        ({}, "no run was heard"),
        ({"recordings": ["nothing.csv"]}, "There is no file nothing.csv"),
    ):
        future = talk.fit(**request)
        talk.until(future.done)
        assert not future.result().success
        assert words in future.result().message


def test_an_unknown_method_is_answered_by_the_nearest_known(talk, recording):
    """A slip of the pen costs no fit."""
    talk.say(recording, recording.sin_theta)
    talk.until(lambda: len(talk.errors) == 61)
    future = talk.fit(method="least_square")
    talk.until(future.done)
    assert (future.result().success, "least_squares" in future.result().message) == (False, True)


def test_an_inactive_node_neither_hears_nor_fits(talk, recording):
    """Deactivated, it publishes no error and refuses a fit with a sentence; active again, it hears."""
    talk.node.trigger_deactivate()
    talk.say(recording, recording.sin_theta)
    answer = talk.fit()
    talk.until(answer.done)
    assert (answer.result().success, "not active" in answer.result().message, talk.errors) == (
        False,
        True,
        [],
    )
    talk.node.trigger_activate()
    talk.say(recording, recording.sin_theta)
    talk.until(lambda: len(talk.errors) > 0)
