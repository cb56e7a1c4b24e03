"""Laws of one's own: where Python finds them, and the hash of their code.

A scene names such a law ``module:class``, and so does a result. It is a class that the program has
imported itself, or that of ``workflow/laws/module.py`` of the project, the folder in which the
program runs. Nothing else is imported: a name in a file that another person sent runs no code but
one's own.
"""

import re
import sys
from importlib import import_module, invalidate_caches
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from pydantic import Field

from geometry.base import SettingsError, check_settings, hashes, require, shown
from simulate.scene.law import Law

FOLDER = Path("workflow/laws")  # of the project
KIND = "[A-Za-z_][A-Za-z0-9_.]{0,99}:[A-Za-z_][A-Za-z0-9_]{0,99}"


def take(file: str | Path) -> None:
    """Import a file with laws, whose classes scenes may then name, and those of its folder.

    Python's store of bytecode is set aside: where size and time of a file are as they were it takes
    the old text for the new one.

    Raises
    ------
    SettingsError
        When it cannot be imported, or its name is that of another module.
    """
    path, kept = Path(file).absolute(), (sys.path, sys.pycache_prefix)
    with TemporaryDirectory() as empty:
        sys.path, sys.pycache_prefix = [*sys.path, str(path.parent)], empty
        invalidate_caches()
        try:
            if not path.samefile(getattr(find_spec(path.stem), "origin", path)):
                raise ImportError("its name is that of another module: rename the file")
            import_module(path.stem)
        except (Exception, SystemExit) as error:  # whatever the file does
            fault = f"{type(error).__name__}: {shown(str(error))}"
            raise SettingsError(f"{file}: cannot be imported ({fault})") from None
        finally:
            sys.path, sys.pycache_prefix = kept


def named(kind: str, code: object = None) -> type[Law]:
    """The law ``module:class``; ``code``: the hash that it must have, if any.

    Raises
    ------
    SettingsError
        When there is none that may be taken; the message says where it should be.
    """
    module, _, name = kind.partition(":")
    if not re.fullmatch(KIND, kind):
        raise SettingsError("should be module:class, of letters, digits, _", key="kind", value=kind)
    file = FOLDER / f"{module}.py"
    if file.is_file():
        take(file)
    law = getattr(sys.modules.get(module), "__dict__", {}).get(name)
    if not (isinstance(law, type) and issubclass(law, Law)) or law.__module__.startswith(
        "simulate."
    ):
        place = f"a file of its own in {FOLDER}" if module == "__main__" else file
        raise SettingsError(
            f"no such law: put the class {name} into {place} of the project; or import it, or name "
            f"its file with --law",
            key="kind",
            value=kind,
        )
    require(
        (
            hashes(law.code_files) == law.code_files,
            "edited since it was imported: start Python anew",
        ),
        (
            code in (None, law.code_hash),
            f"its code has the hash {law.code_hash}, not {shown(code)}: it was changed; run the "
            f"scene anew",
        ),
        kind=SettingsError,
        key="kind",
        value=kind,
    )
    return law


class Unread(Law, extra="allow"):
    """A law in a result whose code is not here, or is another one: to be read, not marched with."""

    kind: str = Field(pattern=f"^{KIND}$")
    why: str = Field(exclude=True)

    @property
    def parameters(self) -> Any:
        """None: each run asks for them.

        Raises
        ------
        SettingsError
            Always: why there are none.
        """
        raise SettingsError(self.why, key="liner.law")


def of_result(values: Any) -> Any:
    """A law in a result, from its ``values``: ``Unread`` where its own cannot be had."""
    kind = values.get("kind") if isinstance(values, dict) else None
    try:
        if isinstance(kind, str) and ":" in kind:
            named(kind, values.get("hash", "of no code"))
    except SettingsError as error:
        return check_settings(Unread, values | {"why": str(error)}, "")
    return values
