"""Which effects share a simulation."""

from hasel_sim.effects.registry import catalogue
from hasel_sysid.candidates import starts
from hasel_sysid.diagnosis.side_by_side import side_by_side


def of(*names: str):
    """Every start of these effects, without effect."""
    return [start.without_effect() for name in names for start in starts(catalogue()[name])]


def test_one_effect_is_in_a_model_once():
    """Four places of a tether are four simulations, in which a creep's two times have room."""
    groups = side_by_side(of("tether", "viscoelastic_creep"))
    assert [[start.effect.id for start in group] for group in groups] == [
        ["tether", "viscoelastic_creep"],
        ["tether", "viscoelastic_creep"],
        ["tether"],
        ["tether"],
    ]


def test_what_does_the_same_is_not_in_one_model():
    """A camera's latency and a dead time exclude each other; a payload goes with either."""
    latency, delay, payload = of("camera_latency", "transport_delay", "payload")
    assert side_by_side([latency, delay, payload]) == [[latency, payload], [delay]]
