"""What a YAML text says, read without the project: its leaves as text, against parsed settings.

PyYAML's BaseLoader keeps all values as they are written. A number is compared with its decimal
reading, so that neither octal numbers nor sixties nor dates can pass as what they are not.
"""

from decimal import Decimal, InvalidOperation
from typing import Any

import yaml
from pydantic import BaseModel

type Leaves = dict[tuple[str, ...], Any]

TRUE, FALSE = {"true", "yes", "on"}, {"false", "no", "off"}
NULL = {"", "~", "null"}
TAGS = ("kind",)  # added by the reader where the text leaves out the default


def leaves(value: Any, at: tuple[str, ...] = ()) -> Leaves:
    """All values that are no mapping or list, by their keys."""
    if isinstance(value, BaseModel):
        value = value.model_dump(exclude_unset=True)
    if isinstance(value, dict):
        items = list(value.items())
    elif isinstance(value, list | tuple):
        items = list(enumerate(value))
    else:
        return {at: value}
    return {k: v for key, item in items for k, v in leaves(item, (*at, str(key))).items()}


def says(text: str) -> Leaves | None:
    """Leaves of a text, as they are written; None where it is no YAML."""
    try:
        return leaves(yaml.load(text, yaml.BaseLoader))
    except (yaml.YAMLError, RecursionError, ValueError):
        return None


def differs(text: str, settings: Any) -> str:
    """How settings differ from what a text says; empty if they do not."""
    return differ(says(text), leaves(settings))


def differ(said: Leaves | None, held: Leaves) -> str:
    """How leaves that are held differ from those that are said; empty if they do not."""
    if said is None:
        return "accepted, but is no YAML"
    if lost := said.keys() - held.keys():
        return f"{sorted(lost)[0]} is said and not held"
    if more := {key for key in held.keys() - said.keys() if key[-1] not in TAGS}:
        return f"{sorted(more)[0]} is held and not said"
    wrong = [key for key in said if not _agree(said[key], held[key])]
    return f"{wrong[0]}: {said[wrong[0]]!r} is read as {held[wrong[0]]!r}" if wrong else ""


def _agree(text: str, value: Any) -> bool:
    if isinstance(value, bool):
        return text.lower() in (TRUE if value else FALSE)
    if value is None:
        return text.lower() in NULL
    if isinstance(value, str):
        return text == value
    try:
        return float(Decimal(text)) == float(value)
    except InvalidOperation:
        return False
