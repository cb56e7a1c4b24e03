"""A figure, drawn by a function of its module."""

from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from importlib import import_module
from pathlib import Path
from types import ModuleType, NoneType, UnionType
from typing import Any, Union, get_args, get_origin, get_type_hints

from geometry.base import Provenance, read_json
from geometry.stored import read as stored
from workflow.figures.response import Response
from workflow.figures.style import save


def draw(module: str, files: Any, png: str, pdf: str, given: Mapping[str, Any]) -> None:
    """Read the files, draw with the values ``given``, and save as PNG and PDF.

    ``module``: one with a function `draw`, or with that named behind a colon.
    """
    module, _, function = module.partition(":")
    figure, function = import_module(module), function or "draw"
    drawn = getattr(figure, function)(*read(figure, files, function), **given)
    save(drawn, png, pdf, origin=origins(files))


def read(figure: ModuleType, files: Any, function: str = "draw") -> Sequence[Any]:
    """Data that a function of a figure draws: its arguments that are files of that name.

    Each is read as its type asks for; a ``Response`` with the reduced model ``files.rom``, if there
    is one.
    """
    kinds = get_type_hints(getattr(figure, function), include_extras=True)
    respond = partial(Response.read, rom=getattr(files, "rom", None))
    return [
        _argument(kind, getattr(files, name), respond)
        for name, kind in kinds.items()
        if hasattr(files, name)
    ]


def _argument(kind: Any, file: Any, respond: Any) -> Any:
    """An argument of type ``kind`` from a path, or from each of a list.

    A text stays a path; others are read by the annotation of the type, by the `load` of its class,
    or else as a JSON file. ``respond`` reads sweeps; no path is None.
    """
    kind = getattr(kind, "__value__", kind)  # of an alias
    kinds = get_args(kind) if get_origin(kind) in (Union, UnionType) else (kind,)
    if file == [] and NoneType in kinds:
        return None
    if isinstance(file, list):
        (of_each,) = get_args(kinds[0])
        return [_argument(of_each, one, respond) for one in file]
    if kinds[0] is Response:
        return respond(file)
    if str in kinds:
        return file
    (reader,) = getattr(kinds[0], "__metadata__", [getattr(kinds[0], "load", read_json)])
    return reader(file)


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
