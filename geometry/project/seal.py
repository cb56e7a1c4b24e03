"""Seal of a file that is read back: its last line holds the hash of all bytes before it.

It is checked before a library opens the file: one that is cut short, or was changed or damaged
since it was written, is refused in one line. Otherwise it might be read as other numbers, or crash
the library. Libraries pass over the line: HDF5 ignores what is behind the end of its data, for Gmsh
and VTK it is a comment.
"""

import hashlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from geometry.project.provenance import ProvenanceError, anew, bytes_of

AROUND = {  # before and after the hash, by suffix; other files have no seal
    ".h5": (b"\nsha256 ", b"\n"),
    ".nc": (b"\nsha256 ", b"\n"),
    ".msh": (b"$Comments\nsha256 ", b"\n$EndComments\n"),
    ".vtu": (b"<!-- sha256 ", b" -->\n"),
}
DIGITS = 64


def seal(path: str | Path) -> None:
    """Append the seal to a complete file, if files with its suffix have one."""
    path = Path(path)
    if path.suffix in AROUND:
        with path.open("ab") as file:
            file.write(_line(path.suffix, path.read_bytes()))


def sealed(path: str | Path) -> bool:
    """Whether the file ends in a seal, right or wrong: it was written here, and not cut short."""
    return bool(_split(Path(path))[1])


def intact(path: str | Path, remedy: str | None = None) -> Path:
    """Return ``path`` if the file is as it was written.

    ``remedy``: what to do with another one, by default to make it anew.

    Raises
    ------
    ProvenanceError
        When it is missing, cut short, changed or damaged; the message says how to make it anew.
    """
    path, remedy = Path(path), remedy or anew(path)
    if path.suffix not in AROUND:
        raise ProvenanceError(f"has no seal: allowed suffixes are {', '.join(AROUND)}", file=path)
    data, last = _split(path, remedy)
    if not last:
        raise ProvenanceError(f"an older version made it, or it is cut short; {remedy}", file=path)
    if last != _line(path.suffix, data):
        raise ProvenanceError(f"damaged or changed since it was written; {remedy}", file=path)
    return path


@contextmanager
def legible(path: str | Path, kind: str, remedy: str | None = None) -> Iterator[Path]:
    """The ``path`` of an ``intact`` file; an error in the block says that it is no ``kind``.

    Raises
    ------
    ProvenanceError
        When it is not intact, or the block does not find in it what it reads.
    """
    try:
        yield intact(path, remedy)
    except (OSError, KeyError, TypeError, ValueError) as error:
        reason = " ".join(str(error).split())
        raise ProvenanceError(
            f"is no {kind} ({reason}); {remedy or anew(path)}", file=path
        ) from None


def _split(path: Path, remedy: str | None = None) -> tuple[memoryview, bytes]:
    """Bytes of a file before its seal, and the seal, right or wrong; empty if there is none."""
    data, (before, after) = memoryview(bytes_of(path, remedy)), AROUND[path.suffix]
    end = max(len(data) - len(before) - DIGITS - len(after), 0)
    last = bytes(data[end:])
    return data[:end], last if last.startswith(before) and last.endswith(after) else b""


def _line(suffix: str, data: bytes | memoryview) -> bytes:
    before, after = AROUND[suffix]
    return before + hashlib.sha256(data).hexdigest().encode() + after
