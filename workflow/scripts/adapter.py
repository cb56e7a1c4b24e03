"""Jobs of all rules: a function is called, its output goes to the rule's log.

Each rule has a script beside this module, which says what is called; its jobs run again when that
changes, and when a module of the project does that it imports, but not when this one changes.

Errors for users also go to the terminal. Where it is one, it also shows how far the work is.
"""

import faulthandler
import gc
import os
import subprocess
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from time import monotonic
from typing import Any

from geometry.base import (
    WARNING,
    Caution,
    UserError,
    bar,
    printable,
    require_writable,
    unchanged,
    write_json,
    write_whole,
)
from workflow.job_cost import usage

gc.disable()  # while modules are imported, a fifth of whose time it takes; ``job`` enables it

CLEARED = "\r\x1b[2K"  # the line of a terminal, and the cursor at its beginning
PAUSE = 5.0  # s, least time between two lines of progress on the terminal
NAMED = 4  # most inputs in a sentence
# Waits for the end of a job, and says so where it ends without a word to it.
WATCH = """
read -r ended && exit
if grep -q -e 'Fatal Python error' -e 'Caught signal number 11' "$2"
then echo "$1: a compiled library crashed on $3: check or make anew what it reads; log: $2"
else echo "$1: killed while it read $3, perhaps out of memory; log: $2"
fi >&2
"""


def job(
    snakemake: Any, call: Callable[[Any, "Teller"], Any], **texts: Callable[[Any], str]
) -> None:
    """Do the job of a rule.

    Parameters
    ----------
    snakemake : what Snakemake gives a script: its input, output, params and wildcards
    call : the work, from that and from what reports progress to a result
    **texts : functions of the result, by the output that has their text; the output ``json`` has
        the result itself
    """
    gc.freeze()
    gc.enable()
    with stage(snakemake) as tell:
        result, outputs = call(snakemake, tell), dict(snakemake.output.items())
        if "json" in outputs:
            write_json(result, outputs["json"])
        for name, text in texts.items():
            write_whole(text(result), outputs[name])


class Teller:
    """Writes lines to the log; on a terminal some of them there, too, with the job's name.

    There lines that count are a bar, which the next one replaces. Of others one is left out that
    comes sooner than ``PAUSE`` after the last; warnings are always written, also where it is no
    terminal.
    """

    def __init__(self, outside: int, name: str) -> None:
        self.outside, self.name = outside, name
        self.shows, self.last, self.bar = os.isatty(outside), -PAUSE, ""

    def __call__(self, line: str) -> None:
        """Tell how far the work is."""
        print(line, flush=True)
        if self.shows and (shown := bar(line)):
            self._draw(f"{self.name} {shown}")
        elif line.startswith(WARNING) or (self.shows and monotonic() - self.last >= PAUSE):
            self._write(line)
            self.last = monotonic()

    def report(self, line: str) -> None:
        """Report a line once: on a terminal always."""
        print(line, flush=True)
        if self.shows or line.startswith(WARNING):
            self._write(line)

    def clear(self) -> None:
        """Remove the bar, so that the next line of other programs stands alone."""
        if self.bar:
            self._draw("")

    def _write(self, line: str) -> None:
        self.clear()
        os.write(self.outside, f"{self.name}: {printable(line)}\n".encode())

    def _draw(self, shown: str) -> None:
        """Replace the bar; the next text overwrites it."""
        width = os.get_terminal_size(self.outside).columns or len(shown) + 1  # 0: not known
        self.bar = printable(shown)[: width - 1]
        os.write(self.outside, f"{CLEARED}{self.bar}\r".encode())


@contextmanager
def stage(snakemake: Any) -> Iterator[Teller]:
    """Redirect stdout and stderr, also of compiled code, to the log; give the ``Teller``.

    The places of the outputs are tried first. Files of users (``params.contents``) are before and
    after as they were when the job was planned, or it fails. A job that succeeds ends its log with
    its CPU time and memory. Errors for users are also written to the terminal, as their message
    with the YAML file that it is about; all others have their traceback in the log.
    Of a job that is killed, or in which a library crashes, a process beside it says so.
    """
    outside = os.dup(2)
    log = os.open(str(snakemake.log[0]), os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(log, 1)
    os.dup2(log, 2)
    faulthandler.enable()
    _repeat_warnings(outside, snakemake)
    about = [str(value) for value in dict(snakemake.wildcards.items()).values()]
    # a job is named by its rule, and the scene or blade, block or row that it is about
    name = " ".join([snakemake.rule, *about[-2:]])
    watch, tell = _watch(outside, snakemake), Teller(outside, name)
    try:
        for path in snakemake.output:
            require_writable(path)
        with unchanged(snakemake.params.get("contents", {})):
            yield tell
        print(usage())
    except Exception as error:
        tell.clear()
        line = _line(snakemake, error)
        os.write(outside, f"{line}\n".encode())
        if not isinstance(error, UserError):
            raise
        raise SystemExit(line) from None  # Python writes it to the log
    finally:
        tell.clear()
        with suppress(BrokenPipeError):
            watch.communicate(b"ended\n")
        sys.stdout.flush()


def _watch(outside: int, snakemake: Any) -> subprocess.Popen:
    """Process that reads a line when the job ends, and else writes that it crashed."""
    inputs = [*map(str, snakemake.input), str(snakemake.params.get("blade") or "settings")]
    reads = [path for path in inputs if not path.endswith(".py")]
    shown = ", ".join(reads[:NAMED]) + (", ..." if reads[NAMED:] else "")
    return subprocess.Popen(
        ["sh", "-c", WATCH, "sh", snakemake.rule, str(snakemake.log[0]), shown],
        stdin=subprocess.PIPE,
        stderr=outside,
    )


def _line(snakemake: Any, message: object) -> str:
    """The message with its rule, and the YAML file of blade or scene unless it names the file."""
    message = "\n".join(map(printable, str(message).split("\n")))
    scene = snakemake.wildcards.get("scene")
    about = snakemake.params.get("blade") or (f"workflow/scenes/{scene}.yaml" if scene else "")
    named = not about or message.startswith(about)
    return f"{snakemake.rule}: {message}" if named else f"{snakemake.rule}: {about}: {message}"


def _repeat_warnings(outside: int, snakemake: Any) -> None:
    """Write a ``Caution`` also to the terminal: logs of jobs that succeed are hardly read."""
    log = warnings.showwarning

    def show(message: Warning | str, category: type[Warning], *where: Any) -> None:
        """Log a warning; write a ``Caution`` to the terminal, too."""
        log(message, category, *where)
        if issubclass(category, Caution):
            os.write(outside, f"{_line(snakemake, message)}\n".encode())

    warnings.showwarning = show
