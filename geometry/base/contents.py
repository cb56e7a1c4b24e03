"""Identity of files by their bytes: time stamps say nothing of files that are moved or unpacked."""

import hashlib
import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from pathlib import Path

from geometry.base.errors import SettingsError, require

DIGITS = 16  # of a hash


def _state(path: str | Path) -> tuple[int, ...]:
    """Device, inode, size, and the times of writing and of any change, ns, of a file.

    The last one the system alone sets: each change of the bytes changes it, with any time stamp.
    """
    of = os.stat(path)
    return of.st_dev, of.st_ino, of.st_size, of.st_mtime_ns, of.st_ctime_ns


def file_hash(path: str | Path) -> str:
    """Hash of a file's bytes, which are read once in a process as long as its state is the same.

    Raises
    ------
    SettingsError
        When the file cannot be read.
    """
    try:
        return _hash(str(path), _state(path))
    except OSError as error:
        raise SettingsError(f"cannot be read ({error.strerror})", file=path) from None


@cache
def _hash(path: str, state: tuple[int, ...]) -> str:
    """Hash of the bytes of a file that is in a ``state``."""
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()[:DIGITS]


def hashes(paths: Iterable[str | Path]) -> dict[str, str]:
    """Hashes of files by their paths."""
    return {str(path): file_hash(path) for path in paths}


@contextmanager
def unchanged(planned: Mapping[str, str]) -> Iterator[None]:
    """Refuse files of users that change in the block, or have changed since it was ``planned``.

    Afterwards all are read again: a change within a tick of the system's clock leaves their state
    as it was. A file that was written to with the bytes that it had is refused, too: others may
    have been read in between.

    >>> _ = Path("table.csv").write_text("1")
    >>> with unchanged(hashes(["table.csv"])):
    ...     _ = Path("table.csv").write_text("2")
    Traceback (most recent call last):
    geometry.base.errors.SettingsError: table.csv: changed while it was read: run it again

    Parameters
    ----------
    planned : hashes, by path

    Raises
    ------
    SettingsError
        When there is such a file.
    """
    if others := [path for path, of in planned.items() if file_hash(path) != of]:
        raise SettingsError("changed since this run was planned: start it again", file=others[0])
    written = {path: _state(path)[:-1] for path in planned}
    yield
    _hash.cache_clear()
    for path, of in planned.items():
        require(
            (
                file_hash(path) == of and _state(path)[:-1] == written[path],
                "changed while it was read: run it again",
            ),
            kind=SettingsError,
            file=path,
        )
