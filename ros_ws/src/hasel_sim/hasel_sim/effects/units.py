"""Which words are units."""

import re

_PREFIXES = ("", "k", "M", "G", "m", "u", "µ", "n", "c", "h")
_BASES = (
    "m",
    "s",
    "g",
    "A",
    "K",
    "rad",
    "sr",
    "N",
    "Pa",
    "J",
    "W",
    "V",
    "C",
    "F",
    "H",
    "S",
    "T",
    "Wb",
    "Hz",
    "Ohm",
    "Ω",
)
_OTHERS = ("1", "deg", "°", "°C", "%", "mol", "bar", "mbar", "min", "h", "px")
_KNOWN = {prefix + base for prefix in _PREFIXES for base in _BASES} | set(_OTHERS)


def is_unit(text: str) -> bool:
    """Whether a text is a product or quotient of units, such as "kg/m^2", "N s/m", "1/s" or "m s⁻¹"."""
    words = re.split(r"[\s*·/().]+", text)
    found = [re.sub(r"(\^?[-+]?\d+|[⁻⁺]?[¹²³⁴])$", "", word) or word for word in words if word]
    return bool(found) and all(word in _KNOWN for word in found)
