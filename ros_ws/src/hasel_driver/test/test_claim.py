"""Who may command."""

import pytest
from hasel_driver.claim import SILENT_S, Claim
from hasel_driver.graph_names import UNNAMED

A, B, C = b"a", b"b", b"c"


class Clock:
    """Time that a test advances."""

    now_s = 0.0

    def __call__(self) -> float:
        return self.now_s


@pytest.fixture
def clock() -> Clock:
    """At 0."""
    return Clock()


def test_arming_gives_it_to_the_only_publisher(clock):
    """Others are refused, however long the holder is silent."""
    claim = Claim(clock)
    claim.hand_out({A: "/a"})
    assert claim.holder == "/a"
    assert claim.take(A, "/a") == (True, False)
    clock.now_s = 100.0
    assert claim.take(B, "/b") == (False, False)
    assert claim.holder == "/a"


def test_without_a_publisher_the_first_that_is_heard_has_it(clock):
    """And it is told as a new one, which must begin at 0 V."""
    claim = Claim(clock)
    claim.hand_out({})
    assert claim.holder == ""
    assert claim.take(B, "/b") == (True, True)
    assert claim.take(A, "/a") == (False, False)


def test_a_node_that_comes_back_has_it_again(clock):
    """By its name, once the first is silent; two at once with one name are not one."""
    claim = Claim(clock)
    claim.hand_out({A: "/controller"})
    assert claim.take(A, "/controller") == (True, False)
    assert claim.take(C, "/controller") == (False, False)
    clock.now_s = 1.1 * SILENT_S
    assert claim.take(C, "/controller") == (True, True)
    assert claim.take(A, "/controller") == (False, False)


def test_nobody_comes_back_whose_name_is_not_known(clock):
    """Two that the graph does not name yet are not one."""
    claim = Claim(clock)
    claim.hand_out({A: UNNAMED})
    clock.now_s = 1.1 * SILENT_S
    assert claim.take(C, UNNAMED) == (False, False)
