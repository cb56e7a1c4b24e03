"""One input as a user might write it, and the verdict on what a reader makes of it.

It is read in a process of its own: what computes without end, takes much memory or crashes in a
library is stopped and seen from outside.
"""

import faulthandler
import json
import os
import resource
import signal
import traceback
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, NamedTuple, Never

from geometry.base import UserError

LONGEST = 500  # characters of a line of a message
TIME = 10  # s of computing for one input; of waiting, as other programs may have the cores:
WAITS = 10  # times that
MEMORY = 2**31  # bytes for one input, beside those that the tester has
GOOD = ("right", "refused")
BAD = ("traceback", "hang", "memory", "crash", "silent", "unclear", "refused wrongly")

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


def judge(case: Case, folder: Path) -> Verdict:
    """Write the files of a case into an empty folder, read them, and judge the answer."""
    _write(case, folder)
    out, into = os.pipe()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # threads of OpenBLAS bear a fork
        process = os.fork()
    if not process:
        _answer(case, folder, into)
    os.close(into)
    with open(out, "rb") as answer:
        said = answer.read()
    code = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
    return Verdict(*json.loads(said)) if said else _ended(code)


def _answer(case: Case, folder: Path, into: int) -> Never:
    """In the process of a case: write its verdict, if it comes to one, and end."""
    try:
        faulthandler.disable()
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        signal.alarm(WAITS * TIME)
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_CPU, (TIME, TIME + 1))
        verdict = _judged(case, folder)
        os.write(into, json.dumps(verdict).encode())
    except BaseException:  # of the tester itself: no answer
        traceback.print_exc()
    finally:
        os._exit(0)


def _ended(code: int) -> Verdict:
    """Verdict on a process that gave none."""
    limits = {signal.SIGXCPU: f"{TIME} s of CPU", signal.SIGALRM: f"{WAITS * TIME} s of waiting"}
    if -code in limits:
        return Verdict("hang", f"after {limits[-code]}")
    return Verdict("crash", signal.strsignal(-code) or "" if code < 0 else "no answer")


def _judged(case: Case, folder: Path) -> Verdict:
    free = resource.getrlimit(resource.RLIMIT_AS)
    has = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (has + MEMORY, free[1]))
    try:
        value = case.read(folder)
    except UserError as error:
        return _refused(case, str(error))
    except MemoryError as error:
        return Verdict("memory", f"above {MEMORY} bytes: {error}"[:LONGEST])
    except Exception as error:  # a bug of the reader, which the tester counts
        return Verdict("traceback", f"{type(error).__name__}: {error}"[:LONGEST])
    finally:
        resource.setrlimit(resource.RLIMIT_AS, free)
    if case.must == "refuse":
        return Verdict("silent", "accepted, but is known to be wrong")
    fault = case.fault(value)
    return Verdict("silent", fault[:LONGEST]) if fault else Verdict("right", "")


def _refused(case: Case, message: str) -> Verdict:
    shown = message[: 2 * LONGEST]
    if case.must == "accept":
        return Verdict("refused wrongly", shown)
    lines = message.split("\n")
    if not all(0 < len(line) <= LONGEST and line.isprintable() for line in lines):
        return Verdict("unclear", shown)
    if not all(any(name in line for name in _names(case)) for line in lines):
        return Verdict("unclear", f"names no file: {shown}")
    return Verdict("refused", shown)


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
