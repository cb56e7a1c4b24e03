"""Numbers of rows that are done, kept by the key of the row: the store that blocks fill.

Each process appends lines to a file of its own. A line is written at once, so that a kill loses
the row in progress alone, and has a check sum: a line that was cut short or changed is no row.
"""

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from uuid import uuid4
from zlib import crc32

from geometry.base import WriteError


class Store:
    """The rows in a folder, which need not exist yet."""

    def __init__(self, folder: str | Path) -> None:
        self.folder = Path(folder)
        self.file = self.folder / f"{uuid4().hex}.rows"  # of this process
        self.keys = {key for key, _ in self._lines()}

    def _lines(self) -> Iterator[tuple[str, bytes]]:
        """Keys and values, as JSON, of all whole lines."""
        for file in sorted(self.folder.glob("*.rows")):
            with file.open("rb") as lines:
                for line in lines:
                    key, _, kept = line.rstrip(b"\n").partition(b" ")
                    found, _, value = kept.partition(b" ")
                    if line.endswith(b"\n") and found == _sum(key + value):
                        yield key.decode(), value

    def add(self, key: str, value: Any) -> None:
        """Append the plain ``value`` of a row.

        Raises
        ------
        geometry.base.errors.WriteError
            When it cannot be written: no room, no permission.
        """
        text = json.dumps(value).encode()
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            with self.file.open("ab") as file:
                file.write(b"%b %b %b\n" % (key.encode(), _sum(key.encode() + text), text))
        except OSError as error:
            fault = f"cannot be written ({error.strerror}): rows that are done are kept"
            raise WriteError(fault, file=self.file) from None
        self.keys.add(key)

    def read(self, keys: set[str], of: Callable[[Any], Any] = dict) -> dict[str, Any]:
        """``of`` the value of each of the ``keys`` that is there; None in it for nan and inf."""
        values = ((key, value) for key, value in self._lines() if key in keys)
        return {key: of(json.loads(value, parse_constant=lambda _: None)) for key, value in values}


def _sum(data: bytes) -> bytes:
    return b"%08x" % crc32(data)
