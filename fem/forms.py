"""Forms and expressions compiled by FFCx, kept on disk for all processes.

FFCx takes the source of a form for a compile in progress, and fails while it is there alone: one
that was killed would fail all later ones. Here one process compiles at a time, and first removes
what others have left. The folder is of this project, for a lock of its own holds no other program.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from fem.petsc import MPI  # noqa: F401  ahead of DOLFINx

from cffi import VerificationError
from numpy.typing import NDArray
from platformdirs import user_cache_path

import ufl
from dolfinx import fem

from geometry.base import WriteError, alone, shown

FOLDER = user_cache_path("tiprub") / "forms"


def compiled(form: ufl.Form) -> Any:
    """``fem.form`` of a form; a ``WriteError`` says why it cannot be compiled or kept."""
    with _options() as options:
        return fem.form(form, jit_options=options)


def compiled_at(of: ufl.core.expr.Expr, points: NDArray) -> fem.Expression:
    """``fem.Expression`` of a tensor at ``points`` (n, 3) of a cell; errors as ``compiled``."""
    with _options() as options:
        return fem.Expression(of, points, jit_options=options)


@contextmanager
def _options() -> Iterator[dict[str, Path]]:
    """Options of a compile in the block.

    Raises
    ------
    WriteError
        When the compiler fails, mostly as it finds no room, or what it made cannot be loaded.
    """
    try:
        with alone(FOLDER) as locked:
            FOLDER.mkdir(parents=True, exist_ok=True)
            FOLDER.chmod(0o700)  # what is in it is run as code
            if locked:
                _remove_unfinished()
            yield {"cache_dir": FOLDER}
    except (OSError, ImportError, VerificationError) as error:
        reason = shown(getattr(error, "strerror", None) or str(error))
        raise WriteError(
            f"the forms of finite elements cannot be compiled there ({reason}): make room there "
            "and for temporary files, remove it, or name another folder by XDG_CACHE_HOME",
            file=FOLDER,
        ) from None


def _remove_unfinished() -> None:
    """Remove files of compiles that did not end; FFCx marks those that did."""
    ended = {path.name.split(".")[0] for path in FOLDER.glob("*.c.cached")}
    for path in FOLDER.iterdir():
        if path.name.split(".")[0] not in ended:
            path.unlink()
