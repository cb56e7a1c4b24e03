"""Checks of settings that concern several keys together."""

from collections.abc import Callable
from functools import wraps
from typing import Any

from pydantic import model_validator


def checked(check: Callable[[Any], None]) -> Any:
    """Decorator of a method of settings that raises a ValueError where their keys do not agree."""

    @model_validator(mode="after")
    @wraps(check)
    def after(settings: Any) -> Any:
        check(settings)
        return settings

    return after
