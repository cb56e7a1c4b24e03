"""Files that appear only when they are complete, and are read back only as they were written.

The seal of a file, its last line, holds the hash of all bytes before it. It is checked before a
library opens the file: one that is cut short, or was changed or damaged since it was written, is
refused in one line. Otherwise it might be read as other numbers, or crash the library. Libraries
pass over the line: HDF5 and pickle ignore bytes behind the end of their data, for Gmsh and VTK
it is a comment. Mappings in JSON have the hash of their values among them.
"""

import hashlib
import json
import os
import platform
import re
import tempfile
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from fcntl import LOCK_EX, flock
from functools import cache
from pathlib import Path
from typing import Any

from geometry.base.errors import WriteError, require, shown
from geometry.base.provenance import (
    ProvenanceError,
    anew,
    bytes_of,
    fingerprint,
    parsed_json,
    readable,
)

TEMPORARY = re.compile(r"\..*\.(\d+)-(\d+)-([0-9a-f]{16})(\.\w+)?")
TRIED = 1 << 16  # bytes written to try a place
HASH = "sha256"  # key of a JSON file: hash of all others
LIST = "[]"  # the only other key where the values are a list
AROUND = {  # before and after the hash, by suffix; other files have no seal
    ".h5": (b"\nsha256 ", b"\n"),
    ".nc": (b"\nsha256 ", b"\n"),
    ".msh": (b"$Comments\nsha256 ", b"\n$EndComments\n"),
    ".vtu": (b"<!-- sha256 ", b" -->\n"),
    ".kernel": (b"\nsha256 ", b"\n"),
}
DIGITS = 64  # of the hash in a seal
UNREADABLE = OSError, KeyError, TypeError, ValueError, RuntimeError, MemoryError  # of libraries
PART = 1 << 24  # bytes of a file that are in memory at a time


@contextmanager
def whole(path: str | Path) -> Iterator[Path]:
    """Yield a temporary path in the folder of ``path``, renamed to it when the block succeeds.

    The temporary name keeps the suffix, by which writers choose their format, and names the
    process, so that two processes do not write the same file. Files of formats that are read back
    get their seal. Leftovers of killed processes in the folder are removed.

    Raises
    ------
    WriteError
        When the file cannot be written: no room, no permission.
    """
    path = Path(path)
    with _temporary(path) as temporary:
        yield temporary
        seal(temporary)
        os.replace(temporary, path)


@contextmanager
def alone(path: Path) -> Iterator[bool]:
    """Let one process at a time into the block, which makes what is at ``path``.

    Yields whether it is alone: where the folder takes no lock all are let in. The lock ends with
    the process, also when it is killed; its empty file stays.
    """
    lock = path.with_name(f".{path.name}.lock")
    with ExitStack() as held:
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            flock(held.enter_context(lock.open("w")), LOCK_EX)
            locked = True
        except OSError:
            locked = False
        yield locked


def write_whole(content: str | bytes, path: str | Path) -> None:
    """Write text or bytes to a file with ``whole``."""
    with whole(path) as temporary:
        temporary.write_bytes(content.encode() if isinstance(content, str) else content)


def require_writable(path: str | Path) -> None:
    """Refuse a path at which no file can be written, before work begins.

    Raises
    ------
    WriteError
        As ``whole``.
    """
    with _temporary(Path(path)) as temporary:
        temporary.write_bytes(bytes(TRIED))


def write_or_keep(save: Callable[[Path], None], path: str | Path) -> None:
    """Call ``save(path)``; where that fails save elsewhere, so that a long computation is not lost.

    Raises
    ------
    WriteError
        If it fails; the message says where the file is instead.
    """
    path = Path(path)
    try:
        save(path)
    except WriteError as error:
        kept = _kept(save, path.name)
        raise WriteError(f"{error}; the result is in {kept}" if kept else str(error)) from None


def _kept(save: Callable[[Path], None], name: str) -> Path | None:
    """Where ``save`` succeeds: in a new folder for temporary files, at home or here."""
    for place in (tempfile.gettempdir(), os.path.expanduser("~"), os.getcwd()):
        with suppress(WriteError, OSError):
            folder = Path(tempfile.mkdtemp(prefix="tiprub-", dir=place))
            try:
                save(folder / name)
            except WriteError:
                folder.rmdir()
                raise
            return folder / name
    return None


@contextmanager
def _temporary(path: Path) -> Iterator[Path]:
    """Temporary path in the folder of ``path``, which is removed at the end."""
    temporary = path.with_name(f".{path.stem}.{_process()}{path.suffix}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        _remove_abandoned(path.parent)
        yield temporary
    except OSError as error:
        reason = error.strerror or str(error).splitlines()[0]
        remedy = "make room there, or choose a place where you may write"
        raise WriteError(f"cannot be written ({reason}); {remedy}", file=path) from None
    finally:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)


def _remove_abandoned(folder: Path) -> None:
    """Remove temporary files in ``folder`` of ended processes of this machine."""
    for file in folder.glob(".*"):
        name = TEMPORARY.fullmatch(file.name)
        if name and name[3] == _machine() and _started(int(name[1])) not in (None, name[2]):
            with suppress(OSError):  # another one removed it, or it is of another user
                file.unlink()


def _process() -> str:
    """Number, start and machine of this process."""
    return f"{os.getpid()}-{_started(os.getpid()) or 0}-{_machine()}"


def _started(process: int) -> str | None:
    """When a process started, in ticks of the machine; "" if it is gone, None if unknown."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[19]
    except OSError:
        return "" if Path("/proc/self/stat").exists() else None


@cache
def _machine() -> str:
    """Hash of the machine, or of the container, in which process numbers have their meaning."""
    numbers = Path("/proc/self/ns/pid")
    return fingerprint([platform.node(), os.readlink(numbers) if numbers.exists() else ""])


def write_json(values: Any, path: str | Path) -> None:
    """Write plain values as JSON, with their hash and ``whole``; nan and inf become null."""
    values = json.loads(json.dumps(values), parse_constant=lambda nan_or_infinity: None)
    values = values if isinstance(values, dict) else {LIST: values}
    values[HASH] = fingerprint(values)
    write_whole(json.dumps(values, indent=1) + "\n", path)


def read_json(path: str | Path) -> Any:
    """Read a JSON file of ``write_json``.

    Raises
    ------
    ProvenanceError
        When it is missing or no JSON, has no hash, or its values are others than those that were
        written.
    """
    try:
        values = parsed_json(bytes_of(path))
    except ValueError:
        raise ProvenanceError(f"damaged or cut short; {anew(path)}", file=path) from None
    found = values.pop(HASH, None) if isinstance(values, dict) else None
    require(
        (
            found,
            "has no hash of its values: another program made it, or an older version; "
            + anew(path),
        ),
        (found == fingerprint(values), f"damaged or changed since it was written; {anew(path)}"),
        kind=ProvenanceError,
        file=path,
    )
    return values[LIST] if values.keys() == {LIST} else values


def seal(path: str | Path) -> None:
    """Append the seal to a complete file, if files with its suffix have one."""
    path = Path(path)
    if path.suffix in AROUND:
        line = _line(path, path.stat().st_size)
        with path.open("ab") as file:
            file.write(line)


def sealed(path: str | Path) -> bool:
    """Whether the file ends in a seal, right or wrong: it was written here, and not cut short."""
    return bool(_split(Path(path))[1])


def intact(path: str | Path, remedy: str | None = None) -> Path:
    """Return ``path`` if the file is as it was written.

    ``remedy``: advice for another one, by default to make it anew.

    Raises
    ------
    ProvenanceError
        When it is missing, cut short, changed or damaged; the message says how to make it anew.
    """
    path, remedy = Path(path), remedy or anew(path)
    if path.suffix not in AROUND:
        raise ProvenanceError(f"has no seal: allowed suffixes are {', '.join(AROUND)}", file=path)
    size, last = _split(path, remedy)
    if not last:
        raise ProvenanceError(f"an older version made it, or it is cut short; {remedy}", file=path)
    if last != _line(path, size):
        raise ProvenanceError(f"damaged or changed since it was written; {remedy}", file=path)
    return path


@contextmanager
def legible(path: str | Path, kind: str, remedy: str | None = None) -> Iterator[Path]:
    """The ``path`` of an ``intact`` file; an error in the block says that it is no ``kind``.

    Raises
    ------
    ProvenanceError
        When it is not intact, or lacks data that the block reads.
    """
    try:
        yield intact(path, remedy)
    except UNREADABLE as error:
        reason = shown(" ".join(str(error).split()))
        raise ProvenanceError(
            f"is no {kind} ({reason}); {remedy or anew(path)}", file=path
        ) from None


def _split(path: Path, remedy: str | None = None) -> tuple[int, bytes]:
    """Bytes before the seal of a file, and the seal, right or wrong; empty if there is none."""
    before, after = AROUND[path.suffix]
    with readable(path, remedy) as file:
        size = max(file.seek(0, os.SEEK_END) - len(before) - DIGITS - len(after), 0)
        file.seek(size)
        last = file.read()
    return size, last if last.startswith(before) and last.endswith(after) else b""


def _line(path: Path, size: int) -> bytes:
    """The seal of the first ``size`` bytes of a file."""
    (before, after), hashed = AROUND[path.suffix], hashlib.sha256()
    with readable(path) as file:
        for start in range(0, size, PART):
            hashed.update(file.read(min(PART, size - start)))
    return before + hashed.hexdigest().encode() + after
