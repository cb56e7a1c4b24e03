"""Version of Tiprub, and the formats of its files.

The number of a format is increased when this version would misread earlier files, or an earlier
version the files of this one.
"""

import tomllib
from collections.abc import Mapping
from functools import cache
from numbers import Integral
from pathlib import Path
from typing import Any

from geometry.project.provenance import ROOT, ProvenanceError, anew


@cache
def version() -> str:
    """Version of Tiprub, from pyproject.toml."""
    pyproject = tomllib.loads((ROOT / "pyproject.toml").read_text())
    return pyproject["project"]["version"]


def other_format(found: float, read: int, of_older: str) -> str:
    """Message for a file of format ``found`` where ``read`` is needed, without the former.

    ``of_older``: what to do with an older file.
    """
    remedy = "use a later Tiprub" if found > read else of_older
    return f"this Tiprub ({version()}) reads format {read}; {remedy}"


def require_format(
    attributes: Mapping[str, Any], read: int, path: str | Path, of_older: str | None = None
) -> None:
    """Refuse a file at ``path`` whose attribute ``format`` is not ``read``.

    Raises
    ------
    ProvenanceError
        If it is not; the message names both formats, and for older files what to do (``of_older``,
        by default to make them anew).
    """
    found, of_older = attributes.get("format"), of_older or anew(path)
    if not isinstance(found, Integral):
        raise ProvenanceError(f"an older version made it; {of_older}", file=path)
    if found != read:
        raise ProvenanceError(
            other_format(int(found), read, of_older),
            file=path,
            key="format",
            value=int(found),
            allowed=read,
        )
