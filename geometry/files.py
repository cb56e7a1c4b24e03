"""Outputs appear whole or not at all."""

import json
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from math import isfinite
from pathlib import Path
from typing import Any


@contextmanager
def whole(path: str | Path) -> Iterator[Path]:
    """Yield a temporary name beside ``path`` and rename it to ``path`` when the block succeeds.

    The temporary name keeps the suffix (writers choose their format by it) and holds the process
    number, so two processes writing the same output cannot mix.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.stem}.{os.getpid()}{path.suffix}")
    try:
        yield temporary
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def write_json(values: Any, path: str | Path) -> None:
    """Write plain values as JSON, whole or not at all; null for what is no number."""
    with whole(path) as temporary:
        temporary.write_text(json.dumps(_plain(values), indent=1, allow_nan=False) + "\n")


def read_json(path: str | Path) -> Any:
    """What ``write_json`` wrote."""
    return json.loads(Path(path).read_text())


def _plain(values: Any) -> Any:
    if isinstance(values, Mapping):
        return {name: _plain(value) for name, value in values.items()}
    if isinstance(values, list | tuple):
        return [_plain(value) for value in values]
    return None if isinstance(values, float) and not isfinite(values) else values
