"""No liner and no casing: free vibration of the blade."""

from typing import ClassVar, Literal

from pydantic import Field

from simulate.scene.law import Law


class NoContact(Law):
    """No contact."""

    touches: ClassVar = False

    kind: Literal["none"] = Field(description="no contact, the blade is alone")
