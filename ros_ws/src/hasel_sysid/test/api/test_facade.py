"""`import hasel_sysid as h`."""

import hasel_sysid
import hasel_sysid.api
import pytest


def test_the_package_offers_what_the_facade_does():
    """Every name, and the same object behind it, packages of the same meaning notwithstanding."""
    for name in hasel_sysid.api.__all__:
        assert getattr(hasel_sysid, name) is getattr(hasel_sysid.api, name)
        assert name in dir(hasel_sysid)


def test_a_name_it_does_not_have_is_answered_with_those_it_has():
    """As Python does, and with what there is."""
    with pytest.raises(AttributeError, match=r"'fitted'; expected one of .* fit, improve"):
        hasel_sysid.fitted  # noqa: B018
