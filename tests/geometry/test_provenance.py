"""Provenance of files: changes that count, changes that do not, and files that are refused."""

from dataclasses import replace

import pytest
from refused import refused

from geometry.base import Provenance, ProvenanceError, code_hash, file_hash, fingerprint

CODE = '''"""A module."""

import ast
import json

NAME = "tip"
SIDES = 6  # of a cube


def area(a):
    """Of a cube."""
    return SIDES * a**2
'''


@pytest.fixture
def hash_of(project_at, tmp_path):
    """Hash of the code, given its text."""

    (tmp_path / "made").mkdir()
    (tmp_path / "made/__init__.py").touch()

    def hash_of(text):
        (tmp_path / "made/module.py").write_text(text)
        project_at(tmp_path)
        return code_hash("made.module")

    return hash_of


@pytest.mark.parametrize(
    ("old", "new", "same"),
    [
        ("Of a cube.", "Of all sides of a cube, m2.", True),
        ("A module.", "Another.", True),
        ("# of a cube", "# and no more", True),
        ("\n\n\ndef", "\n\n\n\n# the area\n\ndef", True),
        ("import ast\nimport json", "import json\nimport ast", False),
        ("import json", "import csv", False),
        ("a**2", "a**3", False),
        ("6", "5", False),
        ("def area(a)", "def area(a, b=0)", False),
        ("def area(a)", "def area(a, /)", False),
        ('"tip"', '"root"', False),
    ],
)
def test_the_hash_is_that_of_code_without_docstrings_and_comments(hash_of, old, new, same):
    assert CODE.count(old) == 1
    assert (hash_of(CODE.replace(old, new)) == hash_of(CODE)) is same


def test_every_module_counts_and_what_it_imports(hash_of, tmp_path):
    other, needing = tmp_path / "made/other.py", CODE + "import made.other\n"
    other.write_text("N = 2\n")
    alone, importing = hash_of(CODE), hash_of(needing)
    other.write_text("N = 3\n")
    assert len({alone, importing, hash_of(needing)}) == 3
    assert code_hash("made.module", "made.other") == code_hash("made.other", "made.module")


ORIGIN = Provenance("reference", "5ead" * 4, {"prestress": "linear", "patches": 8}, "c0de" * 4)


@pytest.mark.parametrize(
    "other",
    [
        {"blade": "another"},
        {"mesh": "0" * 16},
        {"settings": {"prestress": "linear", "patches": 16}},
        {"code": "0" * 16},
    ],
)
def test_file_of_another_origin_is_refused(other):
    ORIGIN.require(replace(ORIGIN), "model.nc")
    error = refused(ProvenanceError, replace(ORIGIN, **other).require, ORIGIN, "model.nc")
    assert error.file == "model.nc"
    assert f", not of {ORIGIN.summary()}; make it anew: `./run snakemake -f" in error.text


def test_title_has_the_blade_and_the_beginnings_of_the_hashes():
    assert ORIGIN.summary() == f"blade reference, mesh 5ead5ead, model {ORIGIN.hash[:8]}"


def test_text_reads_back_in_any_order_and_tuples_are_lists_as_json_has_them():
    assert Provenance.parse(ORIGIN.dump(), "a.nc") == ORIGIN
    for settings, same in (
        (dict(reversed(ORIGIN.settings.items())), True),
        ({"points_mm": ((1.0, 2.0, 3.0),)}, False),
    ):
        made = replace(ORIGIN, settings=settings)
        assert Provenance.parse(made.dump(), "a.nc").hash == made.hash
        assert (made.hash == ORIGIN.hash) is same


@pytest.mark.parametrize("text", [None, "mesh 5ead; eta 1", "{}", '{"blade": "reference"}', "3"])
def test_file_of_an_older_version_is_refused(text):
    assert refused(ProvenanceError, Provenance.parse, text, "a.nc").file == "a.nc"


def test_what_is_made_from_it_has_its_origin_and_more_settings():
    made = ORIGIN.made(["geometry.hats"], basis="enriched")
    assert (made.blade, made.mesh) == (ORIGIN.blade, ORIGIN.mesh)
    assert made.settings == ORIGIN.settings | {"basis": "enriched"}
    made.require_code(["geometry.hats"], "a.nc")
    assert refused(ProvenanceError, made.require_code, ["geometry.tip"], "a.nc").file == "a.nc"


def test_other_settings_of_the_blade_now_are_refused_with_both_values():
    made = ORIGIN.made([], directions="rtz")  # which no blade has
    made.require_settings(ORIGIN.settings, "a.nc")
    other = ORIGIN.settings | {"patches": 16}
    error = refused(ProvenanceError, made.require_settings, other, "a.nc", match="patches 8.* 16;")
    assert error.file == "a.nc"


def test_another_mesh_is_refused_where_there_is_one(tmp_path):
    mesh = tmp_path / "blade.msh"
    ORIGIN.require_mesh(mesh, "a.nc")  # not there: nothing to compare
    mesh.write_bytes(b"$MeshFormat")
    assert refused(ProvenanceError, ORIGIN.require_mesh, mesh, "a.nc").file == "a.nc"
    replace(ORIGIN, mesh=file_hash(mesh)).require_mesh(mesh, "a.nc")


def test_fingerprint_has_sixteen_digits():
    assert len(fingerprint({"a": 1})) == len(file_hash(__file__)) == 16
    assert fingerprint({"a": 1}) != fingerprint({"a": 2})
