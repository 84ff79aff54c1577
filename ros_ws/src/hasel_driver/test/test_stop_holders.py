"""One flag for each publisher."""

from hasel_driver.graph_names import UNNAMED
from hasel_driver.stop_holders import StopHolders

A, B = b"a", b"b"


def test_only_its_own_false_releases():
    """The order of arrival of other publishers' messages does not matter."""
    holders = StopHolders()
    holders.take(A, 1, "/a", True)
    holders.take(B, 1, "/b", False)
    assert holders.names({A: "/a", B: "/b"}) == ["/a"]
    holders.take(A, 2, "/a", False)
    assert not holders


def test_a_message_heard_twice_counts_once():
    """A late copy of an old true does not take the place of a newer false."""
    holders = StopHolders()
    assert holders.take(A, 1, "/a", True)
    assert holders.take(A, 2, "/a", False)
    assert not holders.take(A, 1, "/a", True)
    assert not holders


def test_an_older_stop_heard_after_its_release_is_still_a_stop():
    """Each of our subscriptions has its own queue: it is told once, and holds nothing any more."""
    holders = StopHolders()
    holders.take(A, 2, "/a", False)
    assert holders.take(A, 1, "/a", True)
    assert not holders.take(A, 1, "/a", True)
    assert not holders


def test_release_names_who_held():
    """Whoever is gone is marked, and released by the service only."""
    holders = StopHolders()
    holders.take(A, 1, "/a", True)
    assert holders.names({}) == ["/a (gone)"]
    assert holders.release() == ["/a"]
    assert not holders


def test_a_name_is_learnt_late_and_kept():
    """A node that ends is nameless for a moment before its publisher goes; who held the stop is still said."""
    holders = StopHolders()
    holders.take(A, 1, UNNAMED, True)
    assert holders.names({A: UNNAMED}) == [UNNAMED]
    assert holders.names({A: "/a"}) == ["/a"]
    assert holders.names({A: UNNAMED}) == ["/a"]
    holders.take(A, 2, UNNAMED, True)
    assert holders.names({}) == ["/a (gone)"]
