"""Dependencies of a module: the project's own files that it imports, as ``grimp`` finds them.

Nothing is imported. An import inside a function counts as any other. Modules loaded by name
``grimp`` cannot see; ``LOADING_ALL`` and ``FACES`` list them.
"""

from functools import cache
from importlib.util import find_spec
from pathlib import Path

from grimp import ImportGraph, build_graph

ROOT = Path(__file__).parents[2]
PACKAGES = ("geometry", "fem", "rom", "simulate", "workflow")
LOADING_ALL = ("simulate.scene.laws",)  # packages that load all of their modules by name
# Packages whose names are loaded when they are asked for, by the module that imports them all.
FACES = {"simulate": "simulate.runs"}


@cache
def sources_of(*modules: str) -> tuple[str, ...]:
    """Files of ``modules`` and of all that they import, relative to the project's root, sorted.

    A module beyond ``PACKAGES``, as one of the tests, is read with the package that holds it.

    >>> sources_of("geometry.hats")
    ('geometry/__init__.py', 'geometry/hats.py')

    Raises
    ------
    ModuleNotFoundError
        When one of ``modules`` is no module of the project.
    """
    beyond = {_package(name) for name in modules if name.split(".")[0] not in PACKAGES}
    graph = _graph(*sorted(beyond))
    if unknown := [module for module in modules if module not in graph.modules]:
        raise ModuleNotFoundError(f"no module {unknown[0]} in {ROOT}", name=unknown[0])
    needed = {*modules}.union(*map(graph.find_upstream_modules, modules))
    return tuple(sorted(str(_file(module).relative_to(ROOT)) for module in needed))


def _file(module: str) -> Path:
    """File of a module of the project."""
    path = ROOT.joinpath(*module.split("."))
    package = path / "__init__.py"  # of a package that was, a folder may be left
    return package if package.is_file() else path.with_suffix(".py")


def _package(module: str) -> str:
    """The package that a module is, or that holds it."""
    return module if _file(module).name == "__init__.py" else module.rpartition(".")[0]


@cache
def _graph(*beyond: str) -> ImportGraph:
    """Imports of the project, those by name and those of a module's own package among them.

    ``beyond``: packages other than ``PACKAGES``; one that is not there has no modules.

    Kept, not only for speed: ``grimp`` has threads, and a forked process that reads anew hangs.
    """
    # A script of a user may stand beside its own fem.py, which Python then takes for ours.
    ours = [
        name
        for name in (*PACKAGES, *beyond)
        if _file(name).exists() and _file(name).samefile(find_spec(name).origin)
    ]
    graph = build_graph(*ours, cache_dir=None)
    loads = {(module, module.rpartition(".")[0]) for module in graph.modules - {*ours}}
    loads |= {(package, module) for module, package in loads if package in LOADING_ALL}
    for face, behind in FACES.items():
        loads |= {(user, behind) for user in graph.find_modules_that_directly_import(face)}
    for importer, imported in loads:
        graph.add_import(importer=importer, imported=imported)
    return graph
