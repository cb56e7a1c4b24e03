"""A figure, drawn by a function of its module."""

from collections.abc import Iterable, Sequence
from functools import partial
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any, get_type_hints

from geometry.base import Provenance
from geometry.stored import read as stored
from workflow.figures.response import Response
from workflow.figures.style import save
from workflow.job_arguments import argument


def draw(module: str, files: Any, png: str, pdf: str, given: dict[str, Any] | None = None) -> None:
    """Read the files, draw with the values ``given``, and save as PNG and PDF.

    ``module``: one with a function `draw`, or with that named behind a colon.
    """
    module, _, function = module.partition(":")
    figure, function = import_module(module), function or "draw"
    drawn = getattr(figure, function)(*read(figure, files, function), **given or {})
    save(drawn, png, pdf, origin=origins(files))


def read(figure: ModuleType, files: Any, function: str = "draw") -> Sequence[Any]:
    """Data that a function of a figure draws: its arguments that are files of that name.

    Each is read as its type asks for; a ``Response`` with the reduced model ``files.rom``, if there
    is one.
    """
    readers = {Response: partial(Response.read, rom=getattr(files, "rom", None))}
    kinds = get_type_hints(getattr(figure, function), include_extras=True)
    return [
        argument(kind, getattr(files, name), readers)
        for name, kind in kinds.items()
        if hasattr(files, name)
    ]


def origins(paths: Iterable[str | Path]) -> str:
    """Scene, blade, mesh and model of each reduced model and sweep in ``paths``, without repeats.

    Raises
    ------
    geometry.base.provenance.ProvenanceError
        When a file holds no provenance.
    """
    texts = []
    for path in (path for path in paths if Path(path).suffix == ".nc"):
        with stored(path, "sweep or model") as dataset:
            attrs = dataset.attrs
        scene = f"scene {attrs['name']}, " if "name" in attrs else ""
        model = Provenance.parse(attrs.get("rom") or attrs.get("provenance"), path)
        texts.append(scene + model.summary())
    return "; ".join(dict.fromkeys(texts))
