"""Text files of users: encodings, what is no file, numbers and lines of tables."""

import os

import pytest
from refused import refused

from geometry.base import SettingsError, csv_rows, number, read_text


@pytest.mark.parametrize(
    ("text", "value"),
    [("5", 5), (" -5.e-3", -5e-3), (".5", 0.5), ("1.0D+01", 10), ("2d3", 2000), ("+1E2", 100)],
)
def test_number(text, value):
    assert number(text) == value


@pytest.mark.parametrize(
    "text", ["", "1_0", "nan", "inf", "infinity", "٣", "0x1F", "1,5", "1 2", "5 mm", "1e400", "--1"]
)
def test_text_that_is_no_number(text):
    refused(ValueError, number, text, match=r"is no number|is too large")


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
def test_text_with_and_without_a_byte_order_mark(tmp_path, encoding):
    (tmp_path / "a").write_text("section,ü", encoding=encoding)
    assert read_text(tmp_path / "a") == "section,ü"


def test_what_is_no_text_file(tmp_path):
    (tmp_path / "wide").write_text("a", encoding="utf-16")
    (tmp_path / "latin").write_text("aü", encoding="latin-1")
    os.mkfifo(tmp_path / "pipe")
    for name, words in {
        "none": r"cannot be read \(No such file",
        "wide": r"it is UTF-16\): save it as UTF-8",
        "latin": r"byte 2 is none\): save it as UTF-8",
        "pipe": "is no file that can be read, but a folder, pipe",
        ".": "is no file that can be read, but a folder",
        "latin\0": "cannot be read|null",
    }.items():
        refused(ValueError, read_text, tmp_path / name, match=words)
    refused(ValueError, read_text, tmp_path / "latin", most=1, match="has 2 bytes: allowed up to 1")


def test_rows_have_the_numbers_of_their_lines(tmp_path):
    (tmp_path / "a.csv").write_text('# what\n\na, b\n 1,"2, x"\r\n')
    assert list(csv_rows(tmp_path / "a.csv")) == [(3, ["a", "b"]), (4, ["1", "2, x"])]


@pytest.mark.parametrize(("text", "line"), [('a,b\n1,"2\n3,4"\n', 2), ("a;b\n", 1), ("a\tb\n", 1)])
def test_line_that_is_no_row(tmp_path, text, line):
    (tmp_path / "a.csv").write_text(text)
    assert refused(SettingsError, list, csv_rows(tmp_path / "a.csv")).line == line
