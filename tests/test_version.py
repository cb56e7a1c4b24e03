"""The version is that of pyproject.toml, wherever it is told."""

import re
import tomllib

import pytest
import yaml
from packaging.specifiers import SpecifierSet

import simulate
from geometry.base import ROOT, version
from simulate.__main__ import main

CHANGELOG = (ROOT / "CHANGELOG.md").read_text()


def test_the_version_is_the_same_everywhere(capsys):
    assert version() == simulate.__version__
    assert yaml.safe_load((ROOT / "CITATION.cff").read_text())["version"] == version()
    latest = re.search(r"^## (\d\S*) - ", CHANGELOG, re.MULTILINE)
    assert latest[1] == version()
    with pytest.raises(SystemExit) as ended:
        main(["--version"])
    assert ended.value.code == 0
    assert capsys.readouterr().out == f"Tiprub {version()}\n"


def test_the_forge_checks_each_python_that_is_allowed():
    allowed = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["requires-python"]
    forge = yaml.safe_load((ROOT / ".github/workflows/checks.yaml").read_text())
    checked = forge["jobs"]["checks"]["strategy"]["matrix"]["python"]
    assert checked == [f"3.{minor}" for minor in range(30) if f"3.{minor}" in SpecifierSet(allowed)]
