"""What jobs depend on, by the imports in their modules, against what Python imports."""

from textwrap import dedent

import pytest

from geometry.project import sources_of

PROJECT = {  # files of a made project
    "rooms/__init__.py": "",
    "rooms/plain.py": "import json",
    "rooms/inner/__init__.py": "",
    "rooms/inner/deep.py": "from ..plain import x",
    "rooms/late.py": "def f():\n    try:\n        import rooms.inner.deep\n    except E: pass",
    "rooms/cases.py": "match x:\n    case 1:\n        from rooms import plain",
    "laws/__init__.py": "from pkgutil import iter_modules",
    "laws/one.py": "",
    "face/__init__.py": "FACE = {'run': 'rooms.plain'}",
    "face/part.py": "",
    "asks.py": "from face import run",
    "asks_not.py": "from face import part",
    "round.py": "import again",
    "again.py": "import round",
}


@pytest.fixture
def made(tmp_path, project_at):
    for name, text in PROJECT.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(dedent(text))
    project_at(tmp_path)


@pytest.mark.parametrize(
    ("module", "files"),
    [
        ("rooms.plain", "rooms/__init__ rooms/plain"),
        ("rooms.inner.deep", "rooms/__init__ rooms/inner/__init__ rooms/inner/deep rooms/plain"),
        (
            "rooms.late",
            "rooms/__init__ rooms/inner/__init__ rooms/inner/deep rooms/late rooms/plain",
        ),
        ("rooms.cases", "rooms/__init__ rooms/cases rooms/plain"),
        ("laws", "laws/__init__ laws/one"),
        ("asks", "asks face/__init__ rooms/__init__ rooms/plain"),
        ("asks_not", "asks_not face/__init__ face/part"),
        ("round", "again round"),
    ],
)
def test_all_forms_of_imports_are_followed(made, module, files):
    assert [file.removesuffix(".py") for file in sources_of(module)] == files.split()


def test_a_module_that_is_not_there_is_refused(made):
    with pytest.raises(ModuleNotFoundError, match=r"no module rooms\.none"):
        sources_of("rooms.plain", "rooms.none")
