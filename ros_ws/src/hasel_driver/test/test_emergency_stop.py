"""The emergency stop: service, latched topic, and what it takes to go on."""

import time

from hasel_driver.faults import FaultCode

STANDBY, ARMED, ACTIVE, FAULT = range(4)


def test_service_grounds_and_latches(driver, shared_rig, ros):
    """The answer is success only with the supply's own proof; afterwards nothing re-arms by itself."""
    for _ in range(3):
        driver.arm()
        ros.drive(lambda: shared_rig.live)
        at_s = time.monotonic()
        answer = ros.trigger("emergency_stop")
        assert (answer.success, "reports its output grounded" in answer.message) == (True, True)
        assert shared_rig.await_live(False) - at_s < 0.5
        assert ros.await_mode(FAULT).fault_code == FaultCode.EMERGENCY_STOP
        assert not ros.trigger("arm").success
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


def test_topic_stops_and_holds(driver, shared_rig, ros):
    """True on the topic grounds; until false is published the fault cannot be cleared."""
    driver.arm()
    ros.drive(lambda: shared_rig.live)
    at_s = time.monotonic()
    ros.emergency_stop_topic(True)
    assert shared_rig.await_live(False) - at_s < 0.5
    assert ros.await_mode(FAULT).fault_code == FaultCode.EMERGENCY_STOP
    assert "publish false" in ros.trigger("clear_fault").message
    ros.emergency_stop_topic(False)
    time.sleep(0.2)
    assert ros.state.mode == FAULT
    assert ros.trigger("clear_fault").success
    ros.await_mode(STANDBY)
