"""The medium section of a model file: the fluid in which the body swims."""

from typing import Any

from hasel_common.names import nearest_name
from pydantic import model_validator

from hasel_sim.model.section import Positive, Section

FLUIDS: dict[str, tuple[float, float]] = {
    "canola_oil": (920.0, 0.07),
    "water": (998.0, 1.0e-3),
    "air": (1.2, 1.8e-5),
}
"""Density [kg/m^3] and dynamic viscosity [Pa s] at room temperature.

Oil: 0.07 Pa s within 20 %, which is what 18 to 25 degrees C and the spread between oils amount to (Diamante and Lan,
Journal of Food Processing 2014, 234583).
"""


class Medium(Section):
    """A fluid by its name, or by density and viscosity; what is given beside a name replaces the known value."""

    fluid: str | None = None
    density_kg_per_m3: Positive
    viscosity_pa_s: Positive

    @model_validator(mode="before")
    @classmethod
    def _known(cls, content: Any) -> Any:
        given = {"fluid": content} if isinstance(content, str) else content
        if not isinstance(given, dict) or given.get("fluid") is None:
            return given
        if given["fluid"] not in FLUIDS:
            raise ValueError(
                f"the fluid '{given['fluid']}' is not known; {nearest_name(str(given['fluid']), FLUIDS)}: give "
                "density_kg_per_m3 and viscosity_pa_s instead of a name"
            )
        density, viscosity = FLUIDS[given["fluid"]]
        return {"density_kg_per_m3": density, "viscosity_pa_s": viscosity, **given}
