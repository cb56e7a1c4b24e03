"""What a module depends on: the project's own files that it imports, read from the syntax trees.

Nothing is imported. An import inside a function counts as any other. A package that loads modules
by name is covered in two forms: with ``iter_modules`` it depends on all of its modules; and who
takes a name from a package that is none of its modules depends on the modules that texts of the
package name.
"""

import ast
from collections.abc import Iterator
from functools import cache
from importlib.util import resolve_name
from pathlib import Path

ROOT = Path(__file__).parents[2]
# Parts of a statement with more statements; expressions hold no import and are not visited.
BLOCKS = ("body", "orelse", "finalbody", "handlers", "cases")


@cache
def sources_of(*modules: str) -> tuple[str, ...]:
    """Files of ``modules`` and of all that they import, relative to the project's root, sorted.

    >>> sources_of("geometry.hats")
    ('geometry/__init__.py', 'geometry/hats.py')

    Raises
    ------
    ModuleNotFoundError
        When one of ``modules`` is no module of the project.
    """
    for module in modules:
        if file_of(module) is None:
            raise ModuleNotFoundError(f"no module {module} in {ROOT}", name=module)
    seen: set[str] = set()
    ahead = [*modules]
    while ahead:
        name = ahead.pop()
        if name not in seen:
            seen.add(name)
            ahead += _next(name)
    return tuple(sorted({file for name in seen if (file := file_of(name))}))


@cache
def file_of(module: str) -> str | None:
    """File of a module, relative to the project's root; None if it is no module of the project."""
    path = module.replace(".", "/")
    files = (f"{path}.py", f"{path}/__init__.py")
    return next((file for file in files if (ROOT / file).is_file()), None)


@cache
def _next(name: str) -> frozenset[str]:
    """Names on which a module, or a name in a package, depends at once; its package among them."""
    package, _, _ = name.rpartition(".")
    if not package or file_of(name):
        return _imported(name) | ({package} if package else set())
    return _texts(package)


def _imported(module: str) -> frozenset[str]:
    """Names in the imports of a module, those of other projects among them."""
    file = file_of(module)
    if file is None:
        return frozenset()
    is_package = file.endswith("__init__.py")
    package = module if is_package else module.rpartition(".")[0]
    names = set()
    for statement in _statements(_tree(file).body):
        if isinstance(statement, ast.Import):
            names |= {alias.name for alias in statement.names}
        elif isinstance(statement, ast.ImportFrom):
            base = resolve_name("." * statement.level + (statement.module or ""), package)
            names |= {base, *(f"{base}.{alias.name}" for alias in statement.names)}
    if is_package and "pkgutil.iter_modules" in names:
        names |= {f"{module}.{path.stem}" for path in (ROOT / file).parent.glob("*.py")}
    return frozenset(names)


def _texts(package: str) -> frozenset[str]:
    """Modules that texts in the ``__init__`` of a package name."""
    file = file_of(package)
    if file is None or not file.endswith("__init__.py"):
        return frozenset()
    constants = (node for node in ast.walk(_tree(file)) if isinstance(node, ast.Constant))
    texts = {node.value for node in constants if isinstance(node.value, str)}
    return frozenset(text for text in texts if text.isprintable() and file_of(text))


def _tree(file: str) -> ast.Module:
    return ast.parse((ROOT / file).read_text())


def _statements(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """All statements, also those inside of others."""
    for statement in body:
        yield statement
        for block in BLOCKS:
            yield from _statements(getattr(statement, block, []))
