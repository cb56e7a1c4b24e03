"""Errors that tell the user what to do; all others are bugs."""

from collections.abc import Iterator
from contextlib import contextmanager


class UserError(Exception):
    """Base of all errors whose message is for users: what is wrong, and what to do about it."""


class MeshError(UserError):
    """Geometry or mesh fails a check; the message has the number and the remedy, in one line."""


class MeshWarning(UserWarning):
    """The mesh can be used, at a cost that the message names."""


@contextmanager
def about(what: object) -> Iterator[None]:
    """Begin the messages of the block with ``what`` they are about, if it is something."""
    try:
        yield
    except MeshError as error:
        raise MeshError(f"{what}: {error}" if what else str(error)) from None


class SettingsError(UserError):
    """Settings that cannot be used; one line per fault: file, key, value, allowed range."""
