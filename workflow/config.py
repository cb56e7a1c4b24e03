"""Settings of workflow/config.yaml, and those given by --config on the command line."""

from collections.abc import Collection, Mapping
from difflib import get_close_matches
from pathlib import Path
from typing import Any, ClassVar

from pydantic import Field

from geometry.base import (
    A_NAME,
    NAME,
    Fault,
    Settings,
    check_settings,
    merged,
    refuse,
)

A_LIST = "a list has brackets, as in [paper-e1, paper-e10]"


class Config(Settings):
    """Settings of workflow/config.yaml."""

    hints: ClassVar = {"scenes": A_LIST, "explore": A_LIST}

    scenes: list[str] = Field(min_length=1, description="Names of files in workflow/scenes/")
    blocks: int = Field(ge=1, le=1000, description="Number of jobs of a sweep")
    explore: list[str] = Field(default=[], description="Scenes with a page to explore")


def read_config(
    path: str | Path, given: Mapping[str, Any] | None = None, scenes: Collection[str] | None = None
) -> Config:
    """Settings of the file at ``path``, with those ``given`` on the command line.

    Names must be among ``scenes``, if these are given.

    Raises
    ------
    SettingsError
        When file or command line are not valid; the message has a line for each fault.
    """
    config = Config.load(path)
    if given:
        both = merged(config.model_dump(exclude_unset=True), dict(given))
        config = check_settings(Config, both, "--config")
    faults = [
        Fault(fault, key, name, file="--config" if key in (given or ()) else str(path))
        for key in ("scenes", "explore")
        for name in getattr(config, key)
        if (fault := _unknown(name, scenes))
    ]
    refuse(faults)
    return config


def _unknown(name: str, scenes: Collection[str] | None) -> str:
    """Why there is no such scene; empty if there is."""
    if not NAME.fullmatch(name):
        return f"no name of a scene; {A_NAME}"
    if scenes is None or name in scenes:
        return ""
    near = "".join(f"; did you mean {other!r}?" for other in get_close_matches(name, scenes, n=1))
    return f"no workflow/scenes/{name}.yaml{near}"
