"""What jobs depend on beside their files: settings, and code."""

import re
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from geometry.base import SettingsError, fingerprint, sources_of

ROOT = Path(__file__).resolve().parents[2]

type OfJob[T] = Callable[[Any], T]  # of the wildcards of a job


class Told(dict[str, Any]):
    """Settings of a job.

    Snakemake compares and shows a short hash of them; jobs get a dictionary.
    """

    def __repr__(self) -> str:
        """The hash."""
        return f"settings {fingerprint(dict(self))[:12]}"

    def __reduce__(self) -> tuple[type[dict], tuple[dict[str, Any]]]:
        """A dictionary, for the script."""
        return dict, (dict(self),)


class Once[T](dict[str, T]):
    """Settings by name; each is read and checked when it is first asked for."""

    def __init__(self, names: Iterable[str], read: Callable[[str], T]) -> None:
        super().__init__(dict.fromkeys(names))
        self.read = cache(read)

    def __getitem__(self, name: str) -> T:
        """Settings of that name.

        Raises
        ------
        SettingsError
            When they are not valid.
        """
        return self.read(name)

    def all(self, names: Iterable[str]) -> dict[str, T]:
        """Settings by name.

        Raises
        ------
        SettingsError
            With all faults of all files, before any job starts.
        """
        faults, names = list[str](), list(dict.fromkeys(names))
        for name in names:
            try:
                self.read(name)
            except SettingsError as error:
                faults += str(error).splitlines()
        if faults:  # of a base or a blade, the same for several names
            raise SettingsError(*dict.fromkeys(faults))
        return {name: self.read(name) for name in names}


def here(files: Iterable[str | Path]) -> list[str]:
    """Paths, relative in the working directory: a project that is moved does not rerun."""
    folder = Path.cwd()
    paths = map(Path, files)
    return [str(f.relative_to(folder) if f.is_relative_to(folder) else f) for f in paths]


def own_files(names: Iterable[str]) -> list[str]:
    """Files of the project, as inputs of jobs that read or import them."""
    return here(ROOT / name for name in names)


def code_of(script: str, *more: str) -> OfJob[list[str]]:
    """Source files that a script of ``workflow/scripts`` imports: its jobs rerun when they change.

    ``more``: further modules, which it loads by name, or their functions, as ``module:function``.
    The files are looked for when a job is needed.
    """
    modules = (f"workflow.scripts.{script}", *(name.partition(":")[0] for name in more))
    found = cache(lambda: own_files(sources_of(*modules)))  # once for all jobs of a rule
    return lambda wildcards: found()


def one_of(names: Iterable[str]) -> str:
    """Pattern of a wildcard that matches one of ``names``; without names it matches nothing."""
    return "|".join(map(re.escape, names)) or "(?!)"


def with_laws(files: Mapping[str, str], laws: Mapping[str, str]) -> Told:
    """Hashes of files of users, with those of the modules of their own laws."""
    return Told(files | dict(zip(here(laws), laws.values(), strict=True)))
