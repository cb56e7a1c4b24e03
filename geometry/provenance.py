"""Where the numbers of a file come from: blade, mesh, settings, and the code that made them."""

import ast
import hashlib
import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any, Self

from geometry.errors import UserError

ROOT = Path(__file__).parents[1]
DIGITS = 16  # of a hash that is shown


class ProvenanceError(UserError):
    """A file that was not made for what it is used for; the message says how to make it anew."""


@dataclass(frozen=True)
class Provenance:
    """Origin of a file; what is made from it has this origin, and more settings and code."""

    blade: str  # name of the blade
    mesh: str  # hash of the mesh file
    settings: dict[str, Any]  # of the blade's file, as far as they decide the numbers
    code: str  # hash of the code, without docstrings and comments

    @property
    def hash(self) -> str:
        """One hash of all of it."""
        return fingerprint(asdict(self))

    def told(self) -> str:
        """One line for titles of outputs."""
        return f"blade {self.blade}, mesh {self.mesh[:8]}, model {self.hash[:8]}"

    def made(self, code: Sequence[str], **settings: Any) -> Self:
        """Origin of what the files ``code`` make from it with more ``settings``."""
        return replace(self, settings=self.settings | settings, code=code_hash(*code))

    def require_code(self, code: Sequence[str], path: str | Path) -> None:
        """Refuse what other code than that of the files ``code`` made.

        Raises
        ------
        ProvenanceError
            With how to make ``path`` anew.
        """
        if self.code != code_hash(*code):
            raise ProvenanceError(f"{path}: another version of the code made it; {anew(path)}")

    def require_settings(self, of_blade: dict[str, Any], path: str | Path) -> None:
        """Refuse what was made with other settings than ``of_blade``, those of the blade now.

        Raises
        ------
        ProvenanceError
            With the first that differs, and how to make ``path`` anew.
        """
        for key, value in self.settings.items():
            if key in of_blade and of_blade[key] != value:
                raise ProvenanceError(
                    f"{path}: made with {key} {json.dumps(value)}, the file of blade {self.blade} "
                    f"says {json.dumps(of_blade[key])}; {anew(path)}"
                )

    def require_mesh(self, mesh: Path, path: str | Path) -> None:
        """Refuse what was made on another mesh than the file ``mesh``, where there is one.

        Raises
        ------
        ProvenanceError
            With how to make ``path`` anew.
        """
        if mesh.is_file() and file_hash(mesh) != self.mesh:
            raise ProvenanceError(f"{path}: made on another mesh than {mesh}; {anew(path)}")

    def require(self, other: Self, path: str | Path) -> None:
        """Refuse a file at ``path`` of this origin where ``other`` is needed.

        Raises
        ------
        ProvenanceError
            With both, and how to make it anew.
        """
        if self.hash != other.hash:
            raise ProvenanceError(
                f"{path}: is of {self.told()}, not of {other.told()}; {anew(path)}"
            )

    def dump(self) -> str:
        """As text, for the attributes of a file."""
        return json.dumps(asdict(self))

    @classmethod
    def parse(cls, text: Any, path: str | Path) -> Self:
        """What ``dump`` gave, read from ``path``.

        Raises
        ------
        ProvenanceError
            When it is none: an older version made the file.
        """
        try:
            return cls(**json.loads(text))
        except (TypeError, ValueError):
            raise ProvenanceError(f"{path}: an older version made it; {anew(path)}") from None


def fingerprint(values: Any) -> str:
    """Hash of plain values."""
    return hashlib.sha256(json.dumps(values, sort_keys=True).encode()).hexdigest()[:DIGITS]


def file_hash(path: str | Path) -> str:
    """Hash of a file's bytes."""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()[:DIGITS]


@cache
def code_hash(*files: str) -> str:
    """Hash of Python ``files`` of the project as they compute: without docstrings and comments."""
    return fingerprint([_bare(ROOT / file) for file in files])


def _bare(path: Path) -> list[str]:
    """Its imports, in any order, and the rest of its syntax tree."""
    tree = ast.parse(path.read_text())
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if isinstance(body, list):
            node.body = [part for part in body if not _is_text(part)]
    imports = [part for part in tree.body if isinstance(part, ast.Import | ast.ImportFrom)]
    tree.body = [part for part in tree.body if part not in imports]
    return [*sorted(map(ast.dump, imports)), ast.dump(tree)]


def _is_text(part: ast.AST) -> bool:
    """A docstring, or another text that nobody reads while the code runs."""
    return (
        isinstance(part, ast.Expr)
        and isinstance(part.value, ast.Constant)
        and isinstance(part.value.value, str)
    )


def anew(path: str | Path) -> str:
    """How to make the file at ``path`` anew."""
    return f"make it anew: `./run snakemake {path}`"
