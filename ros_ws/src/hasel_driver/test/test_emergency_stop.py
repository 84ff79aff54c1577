"""The emergency stop: service, latched topic, and what it takes to go on."""

import time

import pytest
from hasel_driver.faults import FaultCode

STANDBY, ARMED, ACTIVE, FAULT = range(4)


@pytest.mark.rounds(3, 40)
def test_service_grounds_and_latches(provoke, ros, rounds):
    """The answer is success only with the supply's own proof; afterwards nothing re-arms by itself."""

    def stop() -> None:
        answer = ros.trigger("emergency_stop")
        assert (answer.success, "reports its output grounded" in answer.message) == (True, True)

    for _ in range(rounds):
        provoke(stop, FaultCode.EMERGENCY_STOP)
        assert ros.trigger("clear_fault").success
        ros.await_mode(STANDBY)


def test_no_proof_no_success(driver, shared_rig, ros):
    """With a silent supply the service says that nothing is proven."""
    driver.arm()
    ros.drive(lambda: shared_rig.live)
    shared_rig.say("silence")
    answer = ros.trigger("emergency_stop")
    assert (answer.success, "Treat the output as live" in answer.message) == (False, True)
    assert "Nothing proves" in ros.await_mode(FAULT).fault_text


@pytest.mark.rounds(1, 40)
def test_topic_stops_and_holds(provoke, ros, rounds):
    """True on the topic grounds; until false is published the fault cannot be cleared."""
    for _ in range(rounds):
        provoke(lambda: ros.emergency_stop_topic(True), FaultCode.EMERGENCY_STOP)
        assert "publish false" in ros.trigger("clear_fault").message
        ros.emergency_stop_topic(False)
        time.sleep(0.2)
        assert ros.state.mode == FAULT
        assert ros.trigger("clear_fault").success
        ros.await_mode(STANDBY)
