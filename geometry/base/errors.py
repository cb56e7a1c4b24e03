"""Errors and warnings for users; any other exception is a bug."""

import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import wraps
from typing import Any, NamedTuple, Self
from unicodedata import category

SHOWN = 80  # characters of a value in a message


class Fault(NamedTuple):
    """One thing that is wrong, as data; its string is the line that users read."""

    text: str  # fault, allowed values and remedy
    key: str = ""  # by its path, as in liner.law.E
    value: Any = None  # where the line is to show it
    allowed: Any = None  # bounds by their names, as {"gt": 0}, or the values allowed
    file: str = ""
    line: int | None = None  # of the file

    def __str__(self) -> str:
        """File, key, value, text and line, as far as there are any."""
        value = "" if self.value is None else shown(self.value)
        parts = [part for part in (self.file, self.key, value, self.text) if part]
        return printable(": ".join(parts) + (f" (line {self.line})" if self.line else ""))


class UserError(Exception):
    """Base of all errors for users; the message names fault and remedy.

    Its ``faults`` are a line each; ``text``, ``key``, ``value``, ``allowed``, ``file`` and ``line``
    are those of the first.

    Parameters
    ----------
    *faults : the faults. A text stands for a fault with nothing else.
    file : set in every one of them; a path or its text.
    **about : further fields of ``Fault``, likewise.
    """

    def __init__(self, *faults: Fault | str, file: object = "", **about: Any) -> None:
        about |= {"file": str(file)} if file else {}
        self.faults = tuple(
            (Fault(fault) if isinstance(fault, str) else fault)._replace(**about)
            for fault in faults
        )
        self.text, self.key, self.value, self.allowed, self.file, self.line = self.faults[0]

    def __str__(self) -> str:
        """A line for each fault."""
        return "\n".join(map(str, self.faults))

    def within(self, file: object = "", key: str = "") -> Self:
        """The error with the file, where a fault names none, and the key that its faults are in."""
        return type(self)(
            *(
                fault._replace(
                    file=fault.file or str(file or ""),
                    key=".".join(part for part in (key, fault.key) if part),
                )
                for fault in self.faults
            )
        )


class MeshError(UserError):
    """Geometry or mesh fails a check; the message has the value and the remedy, in one line."""


class SettingsError(UserError, ValueError):
    """Settings that are not valid; one line per fault: file, key, value, allowed range.

    Validators raise it as well, with the key from their own model on.
    """


class WriteError(UserError):
    """A file that cannot be written; the message names it and says why."""


class Caution(UserWarning):
    """Base of all warnings for users: work goes on, and the message names the suspected fault."""


class MeshWarning(Caution):
    """The mesh can be used, with a disadvantage that the message names."""


type Check = tuple[Any, str]  # whether it holds, and the fault where it does not


def failed[F: Fault | str](*checks: tuple[Any, F]) -> list[F]:
    """The faults of the checks that do not hold."""
    return [fault for holds, fault in checks if not holds]


def require(
    *checks: tuple[Any, Fault | str], kind: Callable[..., Exception] = MeshError, **about: Any
) -> None:
    """Refuse by the first fault whose check does not hold.

    Parameters
    ----------
    kind, **about : of the error that is raised, as of ``UserError``; a ``ValueError`` has no more.
    """
    if faults := failed(*checks):
        raise kind(faults[0], **about)


def refuse(
    faults: Iterable[Fault | str], kind: type[UserError] = SettingsError, **about: Any
) -> None:
    """Refuse by all ``faults``, a line each; without any nothing is refused.

    ``kind``, ``about``: as of ``require``.
    """
    if lines := {str(fault): fault for fault in faults}:
        raise kind(*lines.values(), **about)


@contextmanager
def about(file: object, kind: type[UserError] = MeshError) -> Iterator[None]:
    """Give errors in the block, of reading a blade's file, the file; all are of the ``kind``."""
    try:
        yield
    except (MeshError, SettingsError) as error:
        raise kind(*error.faults).within(file) from None


def command(main: Callable[..., int | None]) -> Callable[..., int]:
    """Decorator of a command line, which returns its exit code, 0 where it returns none.

    For unusable input that is 2, with a line for each fault on stderr; after Ctrl-C it is 130.
    """

    @wraps(main)
    def run(*arguments: Any, **named: Any) -> int:
        """Exit code of ``main``; the faults of unusable input go to stderr."""
        try:
            return main(*arguments, **named) or 0
        except UserError as error:
            print(error, file=sys.stderr)
            return 2
        except KeyboardInterrupt:
            print("interrupted; the same command begins again", file=sys.stderr)
            return 130

    return run


def printable(text: str) -> str:
    r"""A line for a terminal: names in files may hold what moves its cursor or hides other text.

    >>> printable("tip\x1b[2K µm")
    'tip\\x1b[2K µm'
    """
    return "".join(c if c.isprintable() or category(c) == "Zs" else repr(c)[1:-1] for c in text)


def shown(value: object) -> str:
    """``repr`` of a value for a message, shortened."""
    text = f"{value:.12g}" if isinstance(value, float) else repr(value)
    text = text.lower() if isinstance(value, bool) else text
    return text if len(text) <= SHOWN else f"{text[: SHOWN - 3]}..."
