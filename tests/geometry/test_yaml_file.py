"""A file on a base says only what differs."""

import pytest

from geometry.errors import SettingsError
from geometry.yaml_file import read_mapping


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


def test_what_a_file_says_replaces_its_base_key_by_key(read):
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
        ({"a": "base: b", "b": "base: a"}, r"b.yaml: base: 'b': comes back to itself"),
    ],
)
def test_a_base_that_is_none_is_named(read, files, what):
    with pytest.raises(SettingsError, match=what):
        read(**files)
