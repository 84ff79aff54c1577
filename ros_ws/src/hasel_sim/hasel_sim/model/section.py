"""What every section of a model file is: known keys only, finite numbers, never changed."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]
Finite = Annotated[float, Field(allow_inf_nan=False)]
Name = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]*$")]
"""A name that can stand in columns, parameters and topics: small letters, digits and underscores."""


class Section(BaseModel):
    """Base of all sections of a model file."""

    model_config = ConfigDict(extra="forbid", frozen=True)
