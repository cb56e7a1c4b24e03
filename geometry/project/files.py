"""Files that appear only when they are complete, and JSON."""

import json
import os
import platform
import re
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import Any

from geometry.project.errors import WriteError
from geometry.project.provenance import ProvenanceError, anew, bytes_of, fingerprint
from geometry.project.seal import seal

TEMPORARY = re.compile(r"\..*\.(\d+)-(\d+)-([0-9a-f]{16})(\.\w+)?")
TRIED = 1 << 16  # bytes written to try a place
HASH = "sha256"  # key of a JSON file: hash of all others


@contextmanager
def whole(path: str | Path) -> Iterator[Path]:
    """Yield a temporary path in the folder of ``path``, renamed to it when the block succeeds.

    The temporary name keeps the suffix, by which writers choose their format, and names the
    process, so that two processes do not write the same file. Files of formats that are read back
    get their seal. What processes that were killed left in the folder is removed.

    Raises
    ------
    WriteError
        When the file cannot be written: no room, no permission.
    """
    path = Path(path)
    with _beside(path) as temporary:
        yield temporary
        seal(temporary)
        os.replace(temporary, path)


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
    with _beside(Path(path)) as temporary:
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
def _beside(path: Path) -> Iterator[Path]:
    """Temporary path in the folder of ``path``, which is removed at the end."""
    temporary = path.with_name(f".{path.stem}.{_process()}{path.suffix}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        _remove_left(path.parent)
        yield temporary
    except OSError as error:
        reason = error.strerror or str(error).splitlines()[0]
        remedy = "make room there, or choose a place where you may write"
        raise WriteError(f"cannot be written ({reason}); {remedy}", file=path) from None
    finally:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)


def _remove_left(folder: Path) -> None:
    """Remove what processes of this machine that are gone were writing in ``folder``."""
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
    """Write plain values as JSON, with ``whole``; nan and inf become null.

    A mapping gets the hash of its values.
    """
    values = json.loads(json.dumps(values), parse_constant=lambda nan_or_infinity: None)
    if isinstance(values, dict):
        values[HASH] = fingerprint(values)
    write_whole(json.dumps(values, indent=1) + "\n", path)


def read_json(path: str | Path) -> Any:
    """Read a JSON file.

    Raises
    ------
    ProvenanceError
        When it is missing or no JSON, or its values are others than those that were written.
    """
    try:
        values = json.loads(bytes_of(path))
    except ValueError:
        raise ProvenanceError(f"damaged or cut short; {anew(path)}", file=path) from None
    if isinstance(values, dict) and values.pop(HASH, None) not in (None, fingerprint(values)):
        raise ProvenanceError(f"damaged or changed since it was written; {anew(path)}", file=path)
    return values
