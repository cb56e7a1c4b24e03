"""A figure, drawn by its module."""

from importlib import import_module
from typing import Any

from workflow.figures.origins import origins
from workflow.figures.style import save


def draw(module: str, files: Any, png: str, pdf: str, given: dict[str, Any] | None = None) -> None:
    """``load`` the files, ``draw``, and save as PNG and PDF."""
    figure = import_module(module)
    loaded = figure.load(files, **given or {})
    save(figure.draw(*loaded), png, pdf, origin=origins(files))
