"""What other nodes do, by what the graph tells: refusals before arming, faults while armed."""

from types import SimpleNamespace

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not there")

from hasel_driver import surroundings
from hasel_driver.errors import RefusedError
from hasel_driver.faults import FaultCode
from hasel_driver.rivals import NOT_TOLD
from hasel_driver.stop_holders import StopHolders
from hasel_driver.surroundings import DISCOVERY_S, NAMING_S, HostSurroundings

NAMED, NAMELESS = "/hasel/hasel_driver on bench2 (process 7)", f"/stranger {NOT_TOLD}"


class Graph:
    """Stands for the inputs: quiet unless a test says otherwise."""

    def __init__(self) -> None:
        self.holders = StopHolders()
        self.others: list[str] = []
        self.deaf: str | None = None
        self.publishers = {b"a": "/a"}
        self.command_topic = "/hasel/command"
        self.stop_topic = SimpleNamespace(present=dict, unheard=lambda: self.deaf)
        self.rivals = SimpleNamespace(known=True, found=lambda: self.others)

    def commanders(self) -> dict[bytes, str]:
        """By identifier."""
        return self.publishers


@pytest.fixture
def graph() -> Graph:
    """One commander, nobody else."""
    return Graph()


@pytest.fixture
def clock(monkeypatch) -> SimpleNamespace:
    """Time that a test advances."""
    clock = SimpleNamespace(now_s=100.0)
    monkeypatch.setattr(surroundings, "time", SimpleNamespace(monotonic=lambda: clock.now_s))
    return clock


def test_a_quiet_graph_allows_arming_and_is_no_threat(graph):
    """Nothing is refused, nothing is a fault."""
    around = HostSurroundings(graph)
    around.check_arming()
    assert around.threat() is None


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda graph: graph.holders.take(b"p", 1, "/panel", True), "held by /panel"),
        (lambda graph: setattr(graph, "deaf", "/x publishes String"), "might not be heard: /x"),
        (lambda graph: setattr(graph, "others", [NAMED]), "on bench2"),
        (lambda graph: setattr(graph.rivals, "known", False), "not known yet"),
        (lambda graph: graph.publishers.update({b"b": "/b"}), "publishes /hasel/command: /a, /b"),
    ],
)
def test_arming_is_refused_with_the_name(graph, change, words):
    """Whoever is in the way is named."""
    change(graph)
    with pytest.raises(RefusedError, match=words):
        HostSurroundings(graph).check_arming()


def test_another_driver_is_a_fault_at_once_or_once_its_name_cannot_be_learnt(graph, clock):
    """With its name and host at once; one that tells no host is given a moment, and no more."""
    around = HostSurroundings(graph)
    graph.others = [NAMED]
    assert around.threat().code is FaultCode.TWO_DRIVERS
    around.calm()
    graph.others = [NAMELESS]
    assert around.threat() is None
    clock.now_s += 1.1 * NAMING_S
    assert "/stranger" in around.threat().detail


def test_a_stop_that_cannot_be_heard_is_a_fault_when_it_lasts(graph, clock):
    """A new publisher is known before it is connected."""
    around = HostSurroundings(graph)
    graph.deaf = "of 2 publishers only 1 is connected"
    assert around.threat() is None
    clock.now_s += 0.9 * DISCOVERY_S
    graph.deaf = None
    assert around.threat() is None
    graph.deaf = "again"
    clock.now_s += 0.9 * DISCOVERY_S
    assert around.threat() is None
    clock.now_s += 1.1 * DISCOVERY_S
    assert around.threat().code is FaultCode.STOP_NOT_HEARD
