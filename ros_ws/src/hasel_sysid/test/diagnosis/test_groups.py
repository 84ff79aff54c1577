"""Which effects are told apart."""

from hasel_sysid.diagnosis.groups import groups


def test_what_fits_as_well_as_the_winner_stands_in_its_group(context):
    """An effect of nearly the same shape is named beside the one that is there; another shape is not."""
    assert groups(context(0.01))[0] == ("much_alike", "sine")


def test_without_a_winner_likeness_alone_decides(context):
    """When nothing is missing, effects that leave nearly the same are still one group."""
    assert groups(context(0.0, chance=0.5)) == [("much_alike", "sine")]
