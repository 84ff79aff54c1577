"""Model files of the former two kinds of body, `swimmer` and `rectangle`, read as descriptions of today."""

from hasel_common.names import nearest_name

from hasel_sim.errors import ModelError

_LENGTHS = ("body_length_m", "fin_length_m", "spine_thickness_m", "largest_half_height_m")
_KEYS = {
    "swimmer": (*_LENGTHS, "outline_coefficients", "head_length_m", "muscle_end_m", "clamped"),
    "rectangle": ("length_m", "height_m", "clamped"),
}


def is_former(content: dict) -> bool:
    """Whether a file's content is of a former kind."""
    return isinstance(content.get("body"), dict) and "kind" in content["body"]


def translated(content: dict) -> dict:
    """The content as a file of today. Raises ModelError for what a file of its kind could not say."""
    content, body = dict(content), dict(content["body"])
    kind = body.pop("kind")
    if kind not in _KEYS:
        raise ModelError(
            f"body.kind is '{kind}'; expected swimmer or rectangle, or no kind and a body as of today: correct it"
        )
    for key in body:
        if key not in _KEYS[kind]:
            raise ModelError(
                f"unknown key 'body.{key}'; {nearest_name(key, _KEYS[kind])}: rename or remove it"
            )
    muscle = content.pop("muscle", None)
    numerics = dict(content.get("numerics", {}))
    numerics.setdefault("quadrature_order", 3)
    content["numerics"] = numerics
    if kind == "rectangle":
        if muscle is not None:
            raise ModelError(
                "a rectangle has no place for the section 'muscle'; expected muscles with channel, layer, from_m and "
                "to_m: describe them so and leave out body.kind"
            )
        return {**content, "body": body}
    missing = [key for key in _KEYS["swimmer"][:-1] if key not in body] + ["muscle"] * (muscle is None)
    if missing:
        raise ModelError(f"the key 'body.{missing[0]}' of a swimmer is missing: add it")
    content["body"] = {
        "length_m": body["body_length_m"],
        "outline": {
            "largest_half_height_m": body["largest_half_height_m"],
            "coefficients": body["outline_coefficients"],
        },
        "spine": {"thickness_m": body["spine_thickness_m"], "fin_length_m": body["fin_length_m"]},
    }
    sides = ("upper", "lower")
    content["channels"] = [{"name": side, "quantity": "voltage", "unit": "V"} for side in sides]
    places = {"from_m": body["head_length_m"], "to_m": body["muscle_end_m"]}
    content["muscles"] = [{"name": s, "channel": s, "layer": s, **places, **muscle} for s in sides]
    return content
