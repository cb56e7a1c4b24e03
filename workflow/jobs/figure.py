"""A figure, drawn by its module."""

from collections.abc import Sequence
from functools import partial
from importlib import import_module
from types import ModuleType
from typing import Any, get_type_hints

from geometry.project import read_json
from workflow.figures.origins import origins
from workflow.figures.response import Response
from workflow.figures.style import save


def draw(module: str, files: Any, png: str, pdf: str, given: dict[str, Any] | None = None) -> None:
    """Read the files, ``draw`` with what is ``given``, and save as PNG and PDF."""
    figure = import_module(module)
    save(figure.draw(*read(figure, files), **given or {}), png, pdf, origin=origins(files))


def read(figure: ModuleType, files: Any) -> Sequence[Any]:
    """What a figure draws: what its ``load`` returns, or without one the files by their types.

    These are the arguments of ``draw`` that are files of that name, each read by the ``load`` of
    its class; a ``Response`` with the reduced model ``files.rom``, if there is one; others are
    values of a JSON file.
    """
    if hasattr(figure, "load"):
        return figure.load(files)
    readers = {Response: partial(Response.read, rom=getattr(files, "rom", None))}
    return [
        readers.get(kind, getattr(kind, "load", read_json))(getattr(files, name))
        for name, kind in get_type_hints(figure.draw).items()
        if hasattr(files, name)
    ]
