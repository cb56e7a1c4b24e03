"""Errors and warnings for users; any other exception is a bug."""

from collections.abc import Iterator
from contextlib import contextmanager


class UserError(Exception):
    """Base of all errors for users; the message says what is wrong and what to do about it."""


class MeshError(UserError):
    """Geometry or mesh fails a check; the message has the value and the remedy, in one line."""


class Caution(UserWarning):
    """Base of all warnings for users: it goes on, and the message says what may be wrong."""


class MeshWarning(Caution):
    """The mesh can be used, with a disadvantage that the message names."""


@contextmanager
def about(what: object) -> Iterator[None]:
    """Prefix messages of ``MeshError`` in the block with ``what``, unless it is empty."""
    try:
        yield
    except MeshError as error:
        raise MeshError(f"{what}: {error}" if what else str(error)) from None


class SettingsError(UserError):
    """Settings that are not valid; one line per fault: file, key, value, allowed range."""


class WriteError(UserError):
    """A file that cannot be written; the message names it and says why."""
