"""Version of Tiprub."""

import tomllib
from functools import cache

from geometry.provenance import ROOT


@cache
def version() -> str:
    """As pyproject.toml has it."""
    pyproject = tomllib.loads((ROOT / "pyproject.toml").read_text())
    return pyproject["project"]["version"]
