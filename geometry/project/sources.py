"""What a module depends on: the project's own files that it imports, read from the syntax trees.

Nothing is imported. An import inside a function counts as any other. A package that loads modules
by name is covered in two forms: with ``iter_modules`` it depends on all of its modules; and who
takes a name from a package that is none of its modules depends on the modules that texts of the
package name.
"""

import ast
import re
from collections.abc import Iterator
from functools import cache
from importlib.util import resolve_name
from pathlib import Path

ROOT = Path(__file__).parents[2]
# Parts of a statement with more statements; expressions hold no import and are not visited.
BLOCKS = ("body", "orelse", "finalbody", "handlers", "cases")
DOTTED = re.compile(r"\w+(\.\w+)*")


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
    if unknown := [module for module in modules if not file_of(module)]:
        raise ModuleNotFoundError(f"no module {unknown[0]} in {ROOT}", name=unknown[0])
    seen: set[str] = set()
    ahead = {*modules}
    while ahead:
        seen |= ahead
        ahead = set().union(*map(_next, ahead)) - seen
    return tuple(sorted({file for name in seen if (file := file_of(name))}))


@cache
def file_of(module: str) -> str:
    """File of a module, relative to the project's root; empty if it is no module of the project."""
    path = module.replace(".", "/")
    files = (f"{path}.py", f"{path}/__init__.py")
    return next((file for file in files if (ROOT / file).is_file()), "")


@cache
def _next(name: str) -> set[str]:
    """Names on which a module, or a name in a package, depends at once; its package among them."""
    package = name.rpartition(".")[0]
    if file := file_of(name):
        return {package, *_imported(file, name if file.endswith("__init__.py") else package)}
    init = file_of(package)
    return _texts(init) if init.endswith("__init__.py") else {package}


def _imported(file: str, package: str) -> Iterator[str]:
    """Names in the imports of a file of ``package``, those of other projects among them."""
    for statement in _statements(ast.parse((ROOT / file).read_text())):
        if isinstance(statement, ast.Import):
            yield from (alias.name for alias in statement.names)
        elif isinstance(statement, ast.ImportFrom):
            base = resolve_name("." * statement.level + (statement.module or ""), package)
            yield from (base, *(f"{base}.{alias.name}" for alias in statement.names))
            if any(alias.name == "iter_modules" for alias in statement.names):
                yield from (f"{package}.{path.stem}" for path in (ROOT / file).parent.glob("*.py"))


def _statements(node: ast.AST) -> Iterator[ast.AST]:
    """All statements of a file, also those inside of others."""
    for block in BLOCKS:
        for statement in getattr(node, block, []):
            yield statement
            yield from _statements(statement)


@cache
def _texts(file: str) -> set[str]:
    """Modules that texts in a file name."""
    tree = ast.parse((ROOT / file).read_text())
    texts = {str(node.value) for node in ast.walk(tree) if isinstance(node, ast.Constant)}
    return {text for text in texts if DOTTED.fullmatch(text) and file_of(text)}
