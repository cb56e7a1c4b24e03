"""A figure, drawn by a function of its module."""

from collections.abc import Sequence
from functools import partial
from importlib import import_module
from types import ModuleType
from typing import Any, get_type_hints

from workflow.arguments import argument
from workflow.figures.origins import origins
from workflow.figures.response import Response
from workflow.figures.style import save


def draw(module: str, files: Any, png: str, pdf: str, given: dict[str, Any] | None = None) -> None:
    """Read the files, draw with what is ``given``, and save as PNG and PDF.

    ``module``: one with a function `draw`, or with that named behind a colon.
    """
    module, _, function = module.partition(":")
    figure, function = import_module(module), function or "draw"
    drawn = getattr(figure, function)(*read(figure, files, function), **given or {})
    save(drawn, png, pdf, origin=origins(files))


def read(figure: ModuleType, files: Any, function: str = "draw") -> Sequence[Any]:
    """What a figure draws: what its ``load`` returns, or without one the files by their types.

    These are the arguments of the function that are files of that name, each read by the ``load``
    of its class; a ``Response`` with the reduced model ``files.rom``, if there is one; others are
    values of a JSON file. An argument with several files is a sequence of them.
    """
    if hasattr(figure, "load"):
        return figure.load(files)
    readers = {Response: partial(Response.read, rom=getattr(files, "rom", None))}
    kinds = get_type_hints(getattr(figure, function))
    named = {name: kind for name, kind in kinds.items() if hasattr(files, name)}
    return [argument(kind, getattr(files, name), readers) for name, kind in named.items()]
