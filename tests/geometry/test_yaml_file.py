"""A file with a base holds only the differences from it."""

import pytest

from geometry.errors import SettingsError
from geometry.yaml_file import names, read_mapping


@pytest.fixture
def read(tmp_path):
    """Write the files, name to text, and read the last one."""

    def written(**files):
        for name, text in files.items():
            (tmp_path / f"{name}.yaml").write_text(text)
        return read_mapping(tmp_path / f"{name}.yaml")

    return written


BELOW = (
    "rounds: 20\nliner: {law: {kind: plastic, E: 1, K: 0.45}, thickness_m: 5.0e-3}\nlist: [1, 2]"
)


def test_the_keys_of_a_file_replace_those_of_its_base(read):
    found = read(below=BELOW, above="base: below\nliner: {law: {E: 10}}")
    law = {"kind": "plastic", "E": 10, "K": 0.45}
    assert found == {"rounds": 20, "liner": {"law": law, "thickness_m": 5e-3}, "list": [1, 2]}


def test_a_list_and_another_kind_replace_whole(read):
    found = read(below=BELOW, above="base: below\nlist: [3]\nliner: {law: {kind: rigid}}")
    assert found["list"] == [3]
    assert found["liner"] == {"law": {"kind": "rigid"}, "thickness_m": 5e-3}


def test_the_same_kind_named_again_keeps_the_rest(read):
    found = read(below=BELOW, above="base: below\nliner: {law: {kind: plastic, E: 2}}")
    assert found["liner"]["law"] == {"kind": "plastic", "E": 2, "K": 0.45}


def test_bases_have_bases(read):
    found = read(below=BELOW, middle="base: below\nrounds: 30", above="base: middle\nlist: []")
    assert (found["rounds"], found["list"]) == (30, [])


def test_null_takes_a_key_away_from_the_base(read):
    assert "rounds" not in read(below=BELOW, above="base: below\nrounds: null")


@pytest.mark.parametrize(
    ("files", "what"),
    [
        ({"above": "base: nowhere"}, r"above.yaml: base: 'nowhere': needs the name of a file"),
        ({"above": "base: 3"}, r"above.yaml: base: 3: needs the name"),
        ({"a": "base: b", "b": "base: a"}, r"a.yaml: base: 'b': comes back to itself \(line 1\)"),
    ],
)
def test_a_missing_base_is_named(read, files, what):
    with pytest.raises(SettingsError, match=what):
        read(**files)


def test_variants_in_one_file_are_read_as_files_of_their_names(read, tmp_path):
    """On a file, on one another and below a file; a file of the same name comes first."""
    variants = "one: {base: below, rounds: 30}\ntwo: {base: one, list: []}\nfile: {rounds: 1}"
    found = read(below=BELOW, variants=variants, file="rounds: 5", above="base: two")
    assert (found["rounds"], found["list"]) == (30, [])
    assert read_mapping(tmp_path / "two.yaml") == found
    assert read_mapping(tmp_path / "file.yaml") == {"rounds": 5}


def test_an_empty_variant_is_named(read):
    with pytest.raises(SettingsError, match=r"variants.yaml: one: holds no 'key: value' lines"):
        read(variants="one: 3", above="base: one")


def test_names_are_those_of_files_and_variants_whatever_they_hold(tmp_path):
    assert names(tmp_path) == []
    for name, text in {"b": "no YAML: [", "variants": "c: 3\na: {}"}.items():
        (tmp_path / f"{name}.yaml").write_text(text)
    assert names(tmp_path) == ["a", "b", "c"]
