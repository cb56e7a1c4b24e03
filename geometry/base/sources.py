"""Dependencies of a module: the project's own files that it imports, as ``grimp`` finds them.

Nothing is imported. An import inside a function counts as any other. Modules loaded by name
``grimp`` cannot see; ``LOADING_ALL`` and ``FACES`` list them.
"""

import ast
import site
import sys
from contextlib import suppress
from functools import cache
from importlib.util import find_spec
from itertools import chain
from pathlib import Path
from sysconfig import get_path

from grimp import ImportGraph, build_graph

from geometry.base.contents import hashes

ROOT = Path(__file__).parents[2]
PACKAGES = ("geometry", "fem", "rom", "simulate", "workflow")
INSTALLED = *map(get_path, ("stdlib", "purelib", "platlib")), site.getusersitepackages()
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


def imported_by(module: str) -> dict[str, str]:
    """Hashes, by path, of a user's module and of all that it imports, in functions, too.

    Of packages all modules count. What is installed is left out, and our own packages, whose code
    has its own hash. Nothing is imported.
    """
    files, queue = list[Path](), [module]
    for name in queue:
        for file in _files_of(name):
            imports = _imports(file) - {*queue, *PACKAGES}
            queue += sorted(imports)
            files.append(file)
    return hashes(dict.fromkeys(files))


def _files_of(name: str) -> list[Path]:
    """Files of a module that is imported, or would be; none of those that are installed."""
    module = sys.modules.get(name)
    spec = getattr(module, "__spec__", None) if module else find_spec(name)
    file = getattr(module, "__file__", None) or (spec and spec.origin)
    folders = (spec and spec.submodule_search_locations) or ()
    places = [Path(of).absolute() for of in (file, *folders) if of]
    mine = [of for of in places if not any(of.is_relative_to(folder) for folder in INSTALLED)]
    files = chain(*(sorted(of.rglob("*.py")) if of.is_dir() else [of] for of in mine))
    return [of for of in files if of.is_file()]


def _imports(file: Path) -> set[str]:
    """Outermost names of what a file imports; none where it is no Python."""
    names = set()
    with suppress(SyntaxError, ValueError):
        for node in ast.walk(ast.parse(file.read_bytes())):
            if isinstance(node, ast.Import):
                names |= {alias.name.partition(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
                names.add(node.module.partition(".")[0])
    return names


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
