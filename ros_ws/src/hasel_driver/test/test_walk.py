"""Everything that can be done to a driver and its hardware, in random order."""

import pytest
from hasel_driver.testing.walk import Walk


@pytest.mark.rounds(12, 240)
def test_a_random_walk_says_nothing_untrue_and_leaves_nothing_live(bench, rounds):
    """No word of grounded above 200 V; nothing live half a second after a stop's last chance. `rounds`: seconds."""
    walk = Walk(bench, seed=rounds)
    walk.run(float(rounds))
    assert walk.live > 0.05 * walk.looks  # or nothing would be tried
    assert walk.wrong == [], "\n".join(walk.log)
