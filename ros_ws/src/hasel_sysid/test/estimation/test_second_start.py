"""Where a fit is begun again."""

from dataclasses import replace

import pytest
from hasel_sim.model import load_model
from hasel_sysid.estimation.second_start import onsets_to_doubt, unseen_parts
from hasel_sysid.testing.made_up_runs import made_up_fit

CHARGE, DISCHARGE = "charging_lag.charge_time", "charging_lag.discharge_time"


@pytest.fixture
def lagging():
    """A fit of a swimmer that charges slowly: what its parameters are, and how well they are known."""

    def fitted(values: dict[str, tuple[float, float | None]], at_bound=(), undetermined=()):
        model = load_model("swimmer").with_levels([3500.0, 5500.0]).with_effects("charging_lag")
        model = model.with_values(
            {name: value for name, (value, _) in values.items()},
            {name: error for name, (_, error) in values.items()},
        )
        return replace(made_up_fit(model, 0.003, at_bound), undetermined=undetermined)

    return fitted


def test_a_part_within_its_error_of_nothing_is_tried_again_beside_one_that_does_something(lagging):
    """Behind the slowest rise a short discharge has hardly a slope; the charge time that is there stays."""
    fit = lagging({CHARGE: (0.1, 0.001), DISCHARGE: (0.0002, 0.008)})
    assert unseen_parts(fit) == {DISCHARGE: 0.05}


def test_a_part_that_is_surely_nothing_or_surely_there_is_not(lagging):
    """0.02 s and 0.008 s more than two errors from nothing: the slope has led here."""
    fit = lagging({CHARGE: (0.1, 0.001), DISCHARGE: (0.008, 0.003)})
    assert unseen_parts(fit) == {}


def test_an_effect_that_is_not_there_at_all_is_tried_again_only_where_nothing_shows_it(lagging):
    """Both times at their null: an answer, unless the recordings cannot tell."""
    nothing = {CHARGE: (0.0, 0.001), DISCHARGE: (0.0, 0.001)}
    assert unseen_parts(lagging(nothing, (CHARGE, DISCHARGE))) == {}
    flat = lagging({CHARGE: (0.0, None), DISCHARGE: (0.0, None)}, (CHARGE, DISCHARGE), (CHARGE, DISCHARGE))
    assert unseen_parts(flat) == {CHARGE: 0.05, DISCHARGE: 0.05}


def test_an_onset_at_its_upper_bound_gives_way_to_none(lagging):
    """There a lag is a delay; within its range, or at nothing, it stays."""
    values = {CHARGE: (0.02, 0.001), DISCHARGE: (0.02, 0.001)}
    assert onsets_to_doubt(lagging({**values, "onset": (2800.0, 90.0)}, ("onset",))) == {"onset": 0.0}
    assert onsets_to_doubt(lagging({**values, "onset": (1500.0, 90.0)})) == {}
    assert onsets_to_doubt(lagging({**values, "onset": (0.0, None)}, ("onset",), ("onset",))) == {}


def test_an_onset_that_nothing_shows_gives_way_to_none(lagging):
    """A play narrower than it does nothing: that is not how to learn how wide it is."""
    values = {CHARGE: (0.02, 0.001), DISCHARGE: (0.02, 0.001), "onset": (2000.0, None)}
    assert onsets_to_doubt(lagging(values, (), ("onset",))) == {"onset": 0.0}
