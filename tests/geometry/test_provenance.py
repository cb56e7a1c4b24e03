"""Provenance of files: changes that count, changes that do not, and files that are refused."""

from dataclasses import replace

import pytest
from refused import refused

import geometry.provenance
from geometry.provenance import Provenance, ProvenanceError, code_hash, file_hash, fingerprint

CODE = '''"""A module."""

SIDES = 6  # of a cube


def area(a):
    """Of a cube."""
    return SIDES * a**2
'''


@pytest.fixture
def hash_of(tmp_path, monkeypatch):
    """Hash of the code, given its text."""
    monkeypatch.setattr(geometry.provenance, "ROOT", tmp_path)

    def hash_of(text):
        (tmp_path / "module.py").write_text(text)
        code_hash.cache_clear()
        return code_hash("module.py")

    yield hash_of
    code_hash.cache_clear()


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("Of a cube.", "Of all sides of a cube, m2."),
        ("A module.", "Another."),
        ("# of a cube", "# and no more"),
        ("\n\n\ndef", "\n\n\n\n# the area\n\ndef"),
        ("    return", '    "An aside."\n    return'),
    ],
)
def test_docstrings_comments_and_blank_lines_do_not_change_the_hash(hash_of, old, new):
    assert CODE.count(old) == 1
    assert hash_of(CODE.replace(old, new)) == hash_of(CODE)


@pytest.mark.parametrize(
    ("old", "new"), [("a**2", "a**3"), ("6", "5"), ("def area(a)", "def area(a, b=0)")]
)
def test_code_changes_the_hash(hash_of, old, new):
    assert hash_of(CODE.replace(old, new)) != hash_of(CODE)


def test_strings_used_by_the_code_change_the_hash(hash_of):
    one, other = 'NAMES = ["tip"]\n', 'NAMES = ["root"]\n'
    assert hash_of(one) != hash_of(other)


def test_the_order_of_imports_does_not_change_the_hash_but_their_names_do(hash_of):
    one, other = "import ast\nimport json\n\nN = 1\n", "import json\nimport ast\n\nN = 1\n"
    assert hash_of(one) == hash_of(other)
    assert hash_of(one) != hash_of(one.replace("json", "csv"))


def test_every_file_counts_and_their_order(hash_of, tmp_path):
    hash_of(CODE)
    (tmp_path / "other.py").write_text("N = 2\n")
    hashes = {code_hash("module.py"), code_hash("module.py", "other.py")}
    assert len(hashes | {code_hash("other.py", "module.py")}) == 3


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
    said = str(error)
    assert said.startswith("model.nc: is of blade ")
    assert f", not of {ORIGIN.summary()}; make it anew: `./run snakemake -f model.nc`" in said


def test_order_of_settings_does_not_matter():
    turned = replace(ORIGIN, settings=dict(reversed(ORIGIN.settings.items())))
    assert turned.hash == ORIGIN.hash


def test_title_has_the_blade_and_the_beginnings_of_the_hashes():
    assert ORIGIN.summary() == f"blade reference, mesh 5ead5ead, model {ORIGIN.hash[:8]}"


def test_text_reads_back_and_tuples_are_lists_as_json_has_them():
    assert Provenance.parse(ORIGIN.dump(), "a.nc") == ORIGIN
    listed = replace(ORIGIN, settings={"points_mm": ((1.0, 2.0, 3.0),)})
    assert Provenance.parse(listed.dump(), "a.nc").hash == listed.hash


@pytest.mark.parametrize("text", [None, "mesh 5ead; eta 1", "{}", '{"blade": "reference"}', "3"])
def test_file_of_an_older_version_is_refused(text):
    error = refused(ProvenanceError, Provenance.parse, text, "a.nc")
    assert str(error) == ("a.nc: an older version made it; make it anew: `./run snakemake -f a.nc`")


def test_what_is_made_from_it_has_its_origin_and_more_settings():
    made = ORIGIN.made(["geometry/hats.py"], basis="enriched")
    assert (made.blade, made.mesh) == (ORIGIN.blade, ORIGIN.mesh)
    assert made.settings == ORIGIN.settings | {"basis": "enriched"}
    made.require_code(["geometry/hats.py"], "a.nc")
    assert refused(ProvenanceError, made.require_code, ["geometry/tip.py"], "a.nc").file == "a.nc"


def test_other_settings_of_the_blade_now_are_refused_with_both_values():
    made = ORIGIN.made([], directions="rtz")  # which no blade has
    made.require_settings(ORIGIN.settings, "a.nc")
    error = refused(
        ProvenanceError, made.require_settings, ORIGIN.settings | {"patches": 16}, "a.nc"
    )
    assert str(error).startswith(
        "a.nc: made with patches 8, the file of blade reference says 16; make it anew"
    )


def test_another_mesh_is_refused_where_there_is_one(tmp_path):
    mesh = tmp_path / "blade.msh"
    ORIGIN.require_mesh(mesh, "a.nc")  # not there: nothing to compare
    mesh.write_bytes(b"$MeshFormat")
    assert refused(ProvenanceError, ORIGIN.require_mesh, mesh, "a.nc").file == "a.nc"
    replace(ORIGIN, mesh=file_hash(mesh)).require_mesh(mesh, "a.nc")


def test_fingerprint_has_sixteen_digits():
    assert len(fingerprint({"a": 1})) == len(file_hash(__file__)) == 16
    assert fingerprint({"a": 1}) != fingerprint({"a": 2})
