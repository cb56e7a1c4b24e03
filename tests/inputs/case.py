"""One input as a user might write it, and the verdict on what a reader makes of it."""

import os
import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, NamedTuple

from geometry.base import UserError

LONGEST = 500  # characters of a line of a message
TIME = 10  # s of computing for one input
WAITS = 0.02  # of it, used in that time: less by what waits for ever
GOOD = ("right", "refused")
BAD = ("traceback", "hang", "silent", "unclear", "refused wrongly")

type Content = bytes | Literal["folder", "pipe"]


@dataclass(frozen=True)
class Case:
    """Files, the call that reads them, and what is known about the answer."""

    kind: str  # of what users write: blade, scene, config, ...
    change: str  # class of what was done to a valid file
    files: dict[str, Content]
    read: Callable[[Path], Any]  # from the folder of the files
    must: Literal["refuse", "accept", "either"]
    fault: Callable[[Any], str] = lambda value: ""  # of an accepted value, against the text

    def __repr__(self) -> str:
        """Enough to make it again by hand."""
        return f"Case({self.kind}, {self.change}, must {self.must}, {self.files!r:.3000})"


class Verdict(NamedTuple):
    """How an input ended, and why it is not good."""

    name: str
    why: str


class _Hang(BaseException):
    """No error of the reader may catch this one."""


def judge(case: Case, folder: Path) -> Verdict:
    """Write the files of a case into an empty folder, read them, and judge the answer."""
    _write(case, folder)
    try:
        with _at_most(TIME):
            value = case.read(folder)
    except _Hang:
        return Verdict("hang", f"after {TIME} s")
    except UserError as error:
        return _refused(case, str(error))
    except Exception as error:  # a bug of the reader, which the tester counts
        return Verdict("traceback", f"{type(error).__name__}: {error}"[:LONGEST])
    if case.must == "refuse":
        return Verdict("silent", "accepted, but is known to be wrong")
    fault = case.fault(value)
    return Verdict("silent", fault) if fault else Verdict("right", "")


def _refused(case: Case, message: str) -> Verdict:
    if case.must == "accept":
        return Verdict("refused wrongly", message)
    lines = message.split("\n")
    if not all(0 < len(line) <= LONGEST and line.isprintable() for line in lines):
        return Verdict("unclear", message)
    if not all(any(name in line for name in _names(case)) for line in lines):
        return Verdict("unclear", f"names no file: {message}")
    return Verdict("refused", message)


def _names(case: Case) -> list[str]:
    return [*case.files, "--config", "the sections", "mesh.element_size_mm", "root face", "tip"]


def _write(case: Case, folder: Path) -> None:
    for name, content in case.files.items():
        path = folder / name
        if content == "folder":
            path.mkdir()
        elif content == "pipe":
            os.mkfifo(path)
        else:
            path.write_bytes(content)


@contextmanager
def _at_most(seconds: float) -> Iterator[None]:
    """Stop a block that takes longer, or waits; time that other programs have does not count."""
    start = time.process_time()

    def stop(*_: Any) -> None:
        used = time.process_time() - start
        if used >= seconds or used < WAITS * seconds:
            raise _Hang
        signal.setitimer(signal.ITIMER_REAL, seconds)

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
