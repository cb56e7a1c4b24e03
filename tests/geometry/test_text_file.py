"""Text files of users: encodings, what is no file, numbers and lines of tables."""

import os
import signal
from contextlib import contextmanager

import pytest
from refused import refused

from geometry.base import SettingsError, csv_rows, number, numbers, read_text, unquoted


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


@contextmanager
def soon():
    """Some seconds of CPU: a pattern that goes back over its text takes minutes."""
    signal.setitimer(signal.ITIMER_VIRTUAL, 5.0)  # the default action of its signal ends Python
    yield
    signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)


@pytest.mark.parametrize(
    "cell", ["1" * 131_071 + "x", "1" * 131_071 + ".", "." + "1" * 131_070, " " * 131_071]
)
def test_long_cells_are_read_in_time(tmp_path, cell):
    with soon():
        try:
            number(cell)
        except ValueError as error:
            assert len(str(error)) < 200
        (tmp_path / "a.csv").write_text(f"{cell}\n")
        list(csv_rows(tmp_path / "a.csv"))


def test_a_table_has_no_more_lines_than_are_allowed(tmp_path, monkeypatch):
    monkeypatch.setattr("geometry.base.text_file.MOST_LINES", 3)
    (tmp_path / "a.csv").write_text("1\n" * 3)
    assert len(list(csv_rows(tmp_path / "a.csv"))) == 3
    (tmp_path / "a.csv").write_text("1\n" * 4)
    refused(SettingsError, list, csv_rows(tmp_path / "a.csv"), match="has 4 lines: allowed 3")


@pytest.mark.parametrize(
    ("name", "quoted"), [("in.csv", True), ("../out.csv", False), ("link.csv", False)]
)
def test_a_table_of_another_folder_is_not_quoted(tmp_path, monkeypatch, name, quoted):
    """Of which a scene from others may name any, as those with passwords."""
    (tmp_path / "project").mkdir()
    monkeypatch.chdir(tmp_path / "project")
    for path in ("in.csv", "../out.csv"):
        with open(path, "w") as file:
            file.write("root:secret\n")
    os.symlink("../out.csv", "link.csv")

    def read():
        with unquoted(name):
            return [numbers(cells, ["a"], line) for line, cells in csv_rows(name)]

    error = refused(SettingsError, read)
    assert ("secret" in str(error)) is quoted
    assert ("outside the folder" in error.text) is not quoted


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
