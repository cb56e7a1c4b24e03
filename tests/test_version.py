"""The version is that of pyproject.toml, wherever it is told."""

import re

import pytest
import yaml

import simulate
from geometry.project import ROOT, version
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
