"""Provenance of a file: blade, mesh, settings, version of the code that made it, and its format.

The number of a format is increased when this version would misread earlier files, or an earlier
version the files of this one.
"""

import hashlib
import json
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from functools import cache
from numbers import Integral
from pathlib import Path
from types import CodeType
from typing import Any, BinaryIO, Self

from geometry.base.contents import DIGITS, file_hash
from geometry.base.errors import UserError
from geometry.base.sources import ROOT, sources_of

# what Python compiles of a function or file, but for its path and the places of its lines
OF_CODE = (
    *("co_name", "co_flags", "co_argcount", "co_posonlyargcount", "co_kwonlyargcount"),
    *("co_code", "co_consts", "co_names", "co_varnames", "co_freevars", "co_exceptiontable"),
)


class ProvenanceError(UserError):
    """A file of another provenance than needed; the message says how to make it anew."""


@dataclass(frozen=True)
class Provenance:
    """Provenance of a file; files made from it add their settings and code."""

    blade: str  # name of the blade
    mesh: str  # hash of the mesh file
    settings: dict[str, Any]  # of the blade's file, those on which the numbers depend
    code: str  # hash of the code, without docstrings and comments

    @property
    def hash(self) -> str:
        """Hash of the provenance."""
        return fingerprint(asdict(self))

    def summary(self) -> str:
        """Blade, mesh and hash in one line, for messages and metadata."""
        return f"blade {self.blade}, mesh {self.mesh[:8]}, model {self.hash[:8]}"

    def made(self, code: Sequence[str], **settings: Any) -> Self:
        """Provenance of a file made from this one by the modules ``code``, with ``settings``."""
        return replace(self, settings=self.settings | settings, code=code_hash(*code))

    def require_code(self, code: Sequence[str], path: str | Path) -> None:
        """Refuse a file that was made by another version of the modules ``code``.

        Raises
        ------
        ProvenanceError
            If it was; the message says how to make ``path`` anew.
        """
        if self.code != code_hash(*code):
            raise ProvenanceError(f"another version of the code made it; {anew(path)}", file=path)

    def require_settings(self, present: dict[str, Any], path: str | Path) -> None:
        """Refuse a file made with other settings than ``present``, the present ones of the blade.

        Raises
        ------
        ProvenanceError
            If it was; the message names the first that differs, and how to make ``path`` anew.
        """
        for key, value in self.settings.items():
            if key in present and present[key] != value:
                raise ProvenanceError(
                    f"made with {key} {json.dumps(value)}, the file of blade {self.blade} says "
                    f"{json.dumps(present[key])}; {anew(path)}",
                    file=path,
                )

    def require_files(self, present: str, path: str | Path) -> None:
        """Refuse a file made of other files of the user than those whose hash is ``present``.

        Raises
        ------
        ProvenanceError
            If it was; the message says how to make ``path`` anew.
        """
        if present and self.settings.get("source", self.mesh) != present:
            raise ProvenanceError(
                f"made of other files than those that blade {self.blade} names; {anew(path)}",
                file=path,
            )

    def require_mesh(self, mesh: Path, path: str | Path) -> None:
        """Refuse a file made on another mesh than the file ``mesh``, if that exists.

        Raises
        ------
        ProvenanceError
            If it was; the message says how to make ``path`` anew.
        """
        if mesh.is_file() and file_hash(mesh) != self.mesh:
            raise ProvenanceError(f"made on another mesh than {mesh}; {anew(path)}", file=path)

    def require(self, other: Self, path: str | Path) -> None:
        """Refuse a file at ``path`` of this provenance if ``other`` is needed.

        Raises
        ------
        ProvenanceError
            If they differ; the message names both, and how to make the file anew.
        """
        if self.hash != other.hash:
            raise ProvenanceError(
                f"is of {self.summary()}, not of {other.summary()}; {anew(path)}", file=path
            )

    def dump(self) -> str:
        """JSON text, for the attributes of a file."""
        return json.dumps(asdict(self))

    @classmethod
    def parse(cls, text: Any, path: str | Path) -> Self:
        """Provenance from the ``text`` of ``dump``, read from ``path``.

        Raises
        ------
        ProvenanceError
            When the text is no provenance: an older version made the file.
        """
        try:
            return cls(**parsed_json(text))
        except (TypeError, ValueError):
            raise ProvenanceError(f"an older version made it; {anew(path)}", file=path) from None


def parsed_json(text: str | bytes) -> Any:
    """Values of a JSON text.

    Raises
    ------
    ValueError
        When it is none, or is nested deeper than Python reads.
    """
    try:
        return json.loads(text)
    except RecursionError:
        raise ValueError("nested too deeply") from None


def bytes_of(path: str | Path, remedy: str | None = None) -> bytes:
    """Bytes of a file that is read back.

    Raises
    ------
    ProvenanceError
        When it is missing or cannot be read; the message has the ``remedy``, by default how to
        make it anew.
    """
    with readable(path, remedy) as file:
        return file.read()


@contextmanager
def readable(path: str | Path, remedy: str | None = None) -> Iterator[BinaryIO]:
    """Open a file for what reads its bytes; raises the errors of ``bytes_of``."""
    try:
        with open(path, "rb") as file:
            yield file
    except OSError as error:
        reason = "no such file" if not Path(path).exists() else f"cannot be read ({error.strerror})"
        raise ProvenanceError(f"{reason}; {remedy or anew(path)}", file=path) from None


def fingerprint(values: Any) -> str:
    """Hash of plain values, via JSON."""
    return hashlib.sha256(json.dumps(values, sort_keys=True).encode()).hexdigest()[:DIGITS]


@cache
def code_hash(*modules: str) -> str:
    """Hash of ``modules`` and all that they import of the project, no docstrings and comments."""
    return fingerprint([_bare(ROOT / file) for file in sources_of(*modules)])


def _bare(path: Path) -> Any:
    """What Python compiles of a file, which has no docstrings and comments."""
    return _plain(compile(path.read_bytes(), path.name, "exec", dont_inherit=True, optimize=2))


def _plain(value: Any) -> Any:
    """A constant of compiled code, or such code without the places of its lines."""
    if isinstance(value, CodeType):
        return [_plain(getattr(value, name)) for name in OF_CODE]
    if isinstance(value, tuple):
        return [_plain(each) for each in value]
    return sorted(map(repr, value)) if isinstance(value, frozenset) else repr(value)


def anew(path: str | Path) -> str:
    """Advice for messages: the command that makes the file at ``path`` anew.

    With ``-f``: Snakemake leaves a file alone that is newer than its sources.
    """
    full = Path(path).resolve()
    target = full.relative_to(ROOT) if full.is_relative_to(ROOT) else path
    return f"make it anew: `./run snakemake -f {target}`"


@cache
def version() -> str:
    """Version of Tiprub, from pyproject.toml."""
    pyproject = tomllib.loads((ROOT / "pyproject.toml").read_text())
    return pyproject["project"]["version"]


def other_format(given: float, read: int, remedy_of_older: str) -> str:
    """Message for a file of format ``given`` where ``read`` is needed, without the former.

    ``remedy_of_older``: advice for an older file.
    """
    remedy = "use a later Tiprub" if given > read else remedy_of_older
    return f"this Tiprub ({version()}) reads format {read}; {remedy}"


def require_format(
    attributes: Mapping[str, Any], read: int, path: str | Path, remedy_of_older: str | None = None
) -> None:
    """Refuse a file at ``path`` whose attribute ``format`` is not ``read``.

    Raises
    ------
    ProvenanceError
        If it is not; the message names both formats, and ``remedy_of_older`` for older files (
        by default to make them anew).
    """
    given, remedy_of_older = attributes.get("format"), remedy_of_older or anew(path)
    if not isinstance(given, Integral):
        raise ProvenanceError(f"an older version made it; {remedy_of_older}", file=path)
    if given != read:
        raise ProvenanceError(
            other_format(int(given), read, remedy_of_older),
            file=path,
            key="format",
            value=int(given),
            allowed=read,
        )
