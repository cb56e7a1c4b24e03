"""No liner and no casing: the blade is alone."""

from typing import ClassVar, Literal

from pydantic import Field

from simulate.law import Law


class NoContact(Law):
    """No contact."""

    touches: ClassVar = False

    kind: Literal["none"] = Field(description="no contact, the blade is alone")
