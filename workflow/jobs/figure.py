"""A figure, drawn by its module."""

from importlib import import_module
from typing import Any

from geometry.project import read_json
from workflow.figures.origins import origins
from workflow.figures.style import save


def load_study(files: Any) -> tuple[Any]:
    """Read the numbers of a study, ``files.study``."""
    return (read_json(files.study),)


def draw(module: str, files: Any, png: str, pdf: str, given: dict[str, Any] | None = None) -> None:
    """``load`` the files, ``draw``, and save as PNG and PDF.

    A figure without ``load`` draws the numbers of a study, ``files.study``.
    """
    figure = import_module(module)
    loaded = getattr(figure, "load", load_study)(files, **given or {})
    save(figure.draw(*loaded), png, pdf, origin=origins(files))
