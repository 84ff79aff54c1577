"""The constants that are set wrong, how far, and of which bodies."""

SIZES = {
    "payload": "payload.mass",
    "soft_modulus": "soft_modulus.scale",
    "added_mass": "added_mass.added_mass",
    "spine_modulus": "spine_modulus.scale",
}
SHIFTS = (-0.6, -0.4, -0.25, -0.1, 0.1, 0.25, 0.4, 0.6)
BODIES = ("beam", "swimmer")
