"""Emergency stops of ROS for a tool that drives the supply while the driver's node is not there."""

import importlib.util
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager

LATCHED_S = 1.0  # within which a stop that is held already is heard, as at the driver's arming


@contextmanager
def stops_of_ros(stop: Callable[[str], None]) -> Iterator[None]:
    """Within it `stop(who)` is called for an emergency stop by topic, and by the service, which is answered.

    Both in the driver's namespace, which `--ros-args -r __ns:=…` changes as for any node; what is heard is said.
    """
    if importlib.util.find_spec("rclpy") is None:
        print("ROS 2 is not there: only the keyboard and the interlock stop.", file=sys.stderr)
        yield
        return
    from hasel_common.managed_node import BackgroundSpin, node_alone
    from hasel_common.topics import EMERGENCY_STOP, NAMESPACE, relative
    from std_srvs.srv import Trigger

    from hasel_driver.middleware import prepare
    from hasel_driver.stop_holders import StopHolders
    from hasel_driver.stop_topic import StopTopic

    def serve(_: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        stop("by service")
        response.success, response.message = (
            False,
            "Stopped; a calibration proves nothing: treat the output as live.",
        )
        return response

    prepare()
    node = node_alone("hasel_calibrate", namespace=NAMESPACE)
    topic = StopTopic(
        node, StopHolders(), lambda asserted, who: stop(f"by topic, from {who}") if asserted else None
    )
    service = node.create_service(Trigger, relative(EMERGENCY_STOP), serve)
    spin = BackgroundSpin(node, "stops", owns_context=True)
    time.sleep(LATCHED_S)
    print(_heard(service.service_name, node.get_topic_names_and_types() + node.get_service_names_and_types()))
    try:
        yield
    finally:
        spin.end()
        topic.destroy()
        spin.close()


def _heard(name: str, present: Iterable[tuple[str, list[str]]]) -> str:
    """What is heard, and what is there and is not, in words."""
    last = name.rpartition("/")[-1]
    others = sorted({each for each, _ in present if each.rpartition("/")[-1] == last} - {name})
    if not others:
        return f"Emergency stops are heard on {name}."
    return (
        f"Emergency stops are heard on {name} only, and there is {', '.join(others)} too: for the supply of another"
        " namespace, such as /rig2, add --ros-args -r __ns:=/rig2."
    )
