"""Progress of work: the part that is done, and the time that is left; and the machine's memory."""

import os
import re
from collections.abc import Callable, Iterable, Iterator
from time import perf_counter

type Say = Callable[[str], None]

WARNING = "warning: "  # begins lines that the user must see
OF = re.compile(r"\w+ (\d+) of (\d+)")  # items counted, in a line of ``left``
BAR = 24  # characters
UNITS = ((86400.0, "days"), (3600.0, "h"), (60.0, "min"), (1.0, "s"))


def duration(seconds: float) -> str:
    """A time in words, two digits.

    >>> duration(0.3), duration(75), duration(20_000), duration(1e6)
    ('0.3 s', '1.2 min', '5.6 h', '12 days')
    """
    size, unit = next(entry for entry in UNITS if seconds >= entry[0] or entry == UNITS[-1])
    number = seconds / size
    return f"{number:.0f} {unit}" if number >= 10 else f"{number:.2g} {unit}"


def memory_of_machine() -> float:
    """Memory of this machine, bytes."""
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")


def remaining(done: int, total: int, elapsed: float) -> str:
    """How far ``done`` of ``total`` is, with the time that is left if all cost alike.

    >>> remaining(5, 20, 10.0), remaining(20, 20, 40.0)
    ('5 of 20, some 30 s left', '20 of 20')
    """
    rest = f", some {duration(elapsed / done * (total - done))} left" if done < total else ""
    return f"{done} of {total}{rest}"


def bar(line: str) -> str:
    """The last that a line of ``left`` counts, as a bar for a terminal; empty of other lines.

    >>> bar("0.300 f1: ok; speed 5 of 20, some 30 s left")
    '[######..................] speed 5 of 20, some 30 s left'
    """
    counts = list(OF.finditer(line))
    if not counts:
        return ""
    done, total = map(int, counts[-1].groups())
    full = "#" * (BAR * done // max(total, 1))
    return f"[{full:.<{BAR}}] {line[counts[-1].start() :]}"


def silent(line: str) -> None:
    """Say nothing."""


def counted[T](items: Iterable[T], total: int, what: str, say: Say) -> Iterator[T]:
    """The items; says after each, when the next is asked for, how far they are."""
    start = perf_counter()
    for done, item in enumerate(items, 1):
        yield item
        say(f"{what} {remaining(done, total, perf_counter() - start)}")
