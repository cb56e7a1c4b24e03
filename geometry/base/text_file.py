"""Text files of users: which of them are read, numbers, and rows of CSV files, also written."""

import csv
import os
import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from contextlib import contextmanager
from io import StringIO
from pathlib import Path

from geometry.base.errors import Fault, SettingsError, UserError, require, shown

MOST_BYTES = 2**26  # of a table; decks of meshes may be larger
MOST_LINES = 2**20  # of a table
NUMBER = re.compile(r"[-+]?(\d+(\.\d*)?|\.\d+)([eEdD][-+]?\d+)?", re.ASCII)


def require_file(path: Path, suffixes: Collection[str]) -> None:
    """Refuse a file that does not exist, or has none of the ``suffixes`` that can be read.

    Raises
    ------
    SettingsError
        Without the path, as ``read_text``.
    """
    require(
        (
            path.suffix.lower() in suffixes,
            Fault(
                f"suffix {path.suffix or 'missing'}: known are {', '.join(suffixes)}",
                value=path.suffix,
                allowed=list(suffixes),
            ),
        ),
        (path.is_file(), "there is no such file"),
        kind=SettingsError,
    )


def read_text(path: str | Path, most: int | None = MOST_BYTES, errors: str = "strict") -> str:
    """Text of a file in UTF-8, with or without a byte-order mark.

    ``errors="replace"`` is for files of other programs, whose comments may be in any encoding.

    Raises
    ------
    SettingsError
        When it cannot be read, is no regular file (reading a pipe would never end), is longer than
        ``most`` bytes, or is no UTF-8 text; the message does not have the path.
    """
    try:
        size = os.path.getsize(path)
        require(
            (os.path.isfile(path), "is no file that can be read, but a folder, pipe or device"),
            (most is None or size <= most, f"has {size} bytes: allowed up to {most}"),
            kind=SettingsError,
        )
        data = Path(path).read_bytes()
    except OSError as error:
        raise SettingsError(f"cannot be read ({error.strerror})") from None
    try:
        return data.decode("utf-8-sig", errors)
    except UnicodeDecodeError as error:
        wide = data.startswith((b"\xff\xfe", b"\xfe\xff"))
        place = f"byte {error.start + 1} is none" if not wide else "it is UTF-16"
        raise SettingsError(f"is no UTF-8 text ({place}): save it as UTF-8") from None


def number(text: str) -> float:
    """A number in decimals, also with the exponent D of Fortran.

    Python's ``float`` would read 1_0 as 10, and also nan and infinity.

    >>> number("1.5D+01"), number(" -.5 ")
    (15.0, -0.5)

    Raises
    ------
    ValueError
        When it is none, or is too large.
    """
    if not NUMBER.fullmatch(text.strip()):
        raise ValueError(f"{shown(text)} is no number")
    value = float(text.upper().replace("D", "E"))
    if abs(value) == float("inf"):
        raise ValueError(f"{shown(text)} is too large")
    return value


def csv_rows(path: str | Path) -> Iterator[tuple[int, list[str]]]:
    """Line numbers and cells of the lines of a CSV file, but for empty ones and comments (#).

    Raises
    ------
    SettingsError
        When the file cannot be read or has too many lines, a quote is not closed in its line, or
        cells are separated by semicolons or tabs.
    """
    lines = read_text(path).splitlines()
    most = f"has {len(lines)} lines: allowed {MOST_LINES}"
    require((len(lines) <= MOST_LINES, most), kind=SettingsError)
    for number, line in enumerate(lines, 1):
        if not line.strip() or line.lstrip()[0] == "#":
            continue
        try:
            (cells,) = csv.reader([line], skipinitialspace=True, strict=True)
        except (csv.Error, ValueError) as error:
            raise SettingsError(f"is no line of a CSV file ({error})", line=number) from None
        require(
            (
                len(cells) != 1 or not {*line.lstrip("{[")[1:]} & {";", "\t"},
                "needs commas between its cells, not ; or tabs",
            ),
            kind=SettingsError,
            line=number,
        )
        yield number, [cell.strip() for cell in cells]


@contextmanager
def unquoted(path: str | Path) -> Iterator[None]:
    """Errors in the block, of reading a table: of a file of other folders without what it holds.

    Settings that another one wrote may name any file that is here.

    Raises
    ------
    SettingsError
        In place of any error for users where the file is not in the working directory.
    """
    try:
        yield
    except (UserError, ValueError):
        here = os.path.join(os.path.realpath("."), "")
        if not os.path.isfile(path) or os.path.realpath(path).startswith(here):
            raise
        raise SettingsError(
            "is no such table; it is outside the folder of this run, so that what it holds is not "
            "shown: copy it into that folder, and name the copy",
            file=path,
        ) from None


def numbers(cells: Sequence[str], columns: Sequence[str], line: int) -> list[float]:
    """Numbers of a line of a CSV file, one for each of the ``columns``.

    Raises
    ------
    SettingsError
        When there are more or fewer, or one is no number; it has the ``line``.
    """
    require(
        (len(cells) == len(columns), f"needs {', '.join(columns)}: found {len(cells)} cells"),
        kind=SettingsError,
        line=line,
    )
    try:
        return [number(cell) for cell in cells]
    except ValueError as error:
        raise SettingsError(f"{error}; needs {', '.join(columns)}", line=line) from None


def csv_text(rows: Iterable[Sequence[object]]) -> str:
    r"""Text of a CSV file.

    >>> csv_text([["E", "says"], [1.5, "a, b"]])
    'E,says\n1.5,"a, b"\n'
    """
    text = StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()
