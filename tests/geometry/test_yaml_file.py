"""A file with a base holds only the differences from it."""

import pytest
from pydantic import Field, model_validator
from refused import refused

from geometry.base import MOST_BASES, Settings, SettingsError, names, read_mapping


@pytest.fixture
def read(tmp_path):
    """Write the files, name to text, and read the last one."""

    def written(**files):
        for name, text in files.items():
            (tmp_path / f"{name}.yaml").write_text(text)
        return read_mapping(tmp_path / f"{name}.yaml")

    return written


BELOW = "rounds: 20\nliner: {law: {kind: plastic, E: 1, K: 0.45}, thickness_mm: 5}\nlist: [1, 2]"


LAW = {"kind": "plastic", "E": 1, "K": 0.45}


@pytest.mark.parametrize(
    ("above", "rounds", "law", "items"),
    [
        ("liner: {law: {E: 10}}", 20, LAW | {"E": 10}, [1, 2]),
        # a list and another kind replace whole; the same kind named again keeps the rest
        ("list: [3]\nliner: {law: {kind: rigid}}", 20, {"kind": "rigid"}, [3]),
        ("liner: {law: {kind: plastic, E: 2}}", 20, LAW | {"E": 2}, [1, 2]),
        ("rounds: null", None, LAW, [1, 2]),  # takes the key away
    ],
)
def test_the_keys_of_a_file_replace_those_of_its_base(read, above, rounds, law, items):
    found = read(below=BELOW, above=f"base: below\n{above}")
    expected = {"rounds": rounds, "liner": {"law": law, "thickness_mm": 5}, "list": items}
    assert found == {key: value for key, value in expected.items() if value is not None}


@pytest.mark.parametrize(
    ("files", "file", "value"),
    [
        ({"above": "base: nowhere"}, "above", "nowhere"),
        ({"above": "base: 3"}, "above", 3),
        ({"a": "base: b", "b": "base: a"}, "a", "b"),
    ],
)
def test_a_missing_base_is_named(read, tmp_path, files, file, value):
    error = refused(SettingsError, read, **files)
    assert (error.file, error.line) == (str(tmp_path / f"{file}.yaml"), 1)
    assert (error.key, error.value) == ("base", value)


def test_variants_in_one_file_are_read_as_files_of_their_names(read, tmp_path):
    """On a file, on one another and below a file; a file of the same name comes first.

    Bases have bases.
    """
    variants = "one: {base: below, rounds: 30}\ntwo: {base: one, list: []}\nfile: {rounds: 1}"
    found = read(below=BELOW, variants=variants, file="rounds: 5", above="base: two")
    assert (found["rounds"], found["list"]) == (30, [])
    assert read_mapping(tmp_path / "two.yaml") == found
    assert read_mapping(tmp_path / "file.yaml") == {"rounds": 5}


def test_an_empty_variant_is_named(read):
    assert refused(SettingsError, read, variants="one: 3", above="base: one").line == 1


def test_names_are_those_of_files_and_variants_whatever_they_hold(tmp_path):
    """But for those that no path or pattern takes."""
    assert names(tmp_path) == []
    odd = ("a(b", "{x}", "a+b", "a b", "ü", "a" * 120, "good_1-A")
    files = {"b": "no YAML: [", "variants": "c: 3\na: {}"} | dict.fromkeys(odd, "x: 1")
    for name, text in files.items():
        (tmp_path / f"{name}.yaml").write_text(text)
    assert names(tmp_path) == ["a", "b", "c", "good_1-A"]


@pytest.mark.parametrize(
    "name", ["../x", "/etc/passwd", "x" * 300, "a(b", "a/b", "..", "'a b'", "ü"]
)
def test_a_base_is_a_name_in_the_same_folder(read, name):
    error = refused(SettingsError, read, above=f"base: {name}")
    assert (error.key, error.value) == ("base", name.strip("'"))


@pytest.mark.parametrize(("bases", "allowed"), [(MOST_BASES, True), (MOST_BASES + 1, False)])
def test_bases_below_one_another_are_limited(read, bases, allowed):
    files = {"b0": "x: 1"} | {f"b{i}": f"base: b{i - 1}" for i in range(1, bases + 1)}
    if allowed:
        assert read(**files) == {"x": 1}
        return
    error = refused(SettingsError, read, **files)
    assert (error.key, error.value) == ("base", "b0")


class Inner(Settings):
    low: float = 0
    high: float = 1

    @model_validator(mode="after")
    def _ordered(self):
        if self.low > self.high:
            raise ValueError("low should be below high")
        return self


class Outer(Settings):
    rounds: int = Field(ge=1)
    inner: Inner = Inner()


@pytest.mark.parametrize(
    ("below", "above", "file", "key", "value", "line"),
    [
        # the base alone has the fault, also where it is no whole file
        ("rounds: 0", "base: below", "below", "rounds", 0, 1),
        ("inner: {}\nrounds: x", "inner: {high: 2}\nbase: below", "below", "rounds", "x", 2),
        ("inner: {low: 2}", "base: below\nrounds: 1", "below", "inner", None, 1),
        ("inner: {}", "base: below", "below", "rounds", None, None),
        # the file has it
        ("rounds: 1", "base: below\nrounds: 0", "above", "rounds", 0, 2),
        ("rounds: 0", "base: below\nrounds: -1", "above", "rounds", -1, 2),
        # only both together
        (
            "rounds: 1\ninner: {low: 0.5}",
            "base: below\ninner:\n  high: 0.1",
            "above",
            "inner",
            None,
            3,
        ),
        ("rounds: 1", "base: below\nrounds: null", "above", "rounds", None, 2),
    ],
)
def test_a_fault_is_told_of_the_file_that_has_it(tmp_path, below, above, file, key, value, line):
    (tmp_path / "below.yaml").write_text(below)
    (tmp_path / "above.yaml").write_text(above)
    error = refused(SettingsError, Outer.load, tmp_path / "above.yaml")
    assert (error.file, error.line) == (str(tmp_path / f"{file}.yaml"), line)
    assert (error.key, error.value) == (key, value)


def test_a_fault_of_a_variant_is_told_of_variants_with_its_line(tmp_path):
    (tmp_path / "variants.yaml").write_text("a: {rounds: 1}\nb: {base: a, rounds: 0}\nc: {base: b}")
    for name in ("b", "c"):
        error = refused(SettingsError, Outer.load, tmp_path / f"{name}.yaml")
        assert (error.file, error.line) == (f"{tmp_path}/variants.yaml: b", 2)
        assert (error.key, error.value, error.allowed) == ("rounds", 0, {"ge": 1})
