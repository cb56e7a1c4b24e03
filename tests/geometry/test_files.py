import errno
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from refused import refused

from geometry.base import (
    ProvenanceError,
    WriteError,
    files,
    read_json,
    require_writable,
    whole,
    write_json,
    write_or_keep,
)


def test_output_appears_under_its_name_only_when_whole(tmp_path):
    target = tmp_path / "new folder" / "page.html"
    with whole(target) as temporary:
        assert temporary.parent == target.parent  # a rename within one file system
        assert temporary.suffix == ".html"
        temporary.write_text("half")
        assert not target.exists()
        temporary.write_text("whole")
    assert target.read_text() == "whole"
    assert os.listdir(target.parent) == ["page.html"]


@pytest.mark.parametrize("before", [None, "old"])
@pytest.mark.parametrize("stop", [ValueError, KeyboardInterrupt])
@pytest.mark.parametrize("half", ["", "half"])
def test_failure_leaves_the_folder_as_it_was(tmp_path, before, stop, half):
    target = tmp_path / "blade.msh"
    if before:
        target.write_text(before)
    with pytest.raises(stop), whole(target) as temporary:
        if half:
            temporary.write_text(half)
        raise stop
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == (
        {"blade.msh": before} if before else {}
    )


def test_two_processes_do_not_share_a_temporary_name(tmp_path, monkeypatch):
    with whole(tmp_path / "a") as first:
        first.touch()
        monkeypatch.setattr(os, "getpid", lambda: 1)
        with whole(tmp_path / "a") as second:
            second.touch()
            assert second != first


KILLED = """
import os, signal, sys
from geometry.base import whole
with whole(sys.argv[1]) as temporary:
    temporary.write_text("half")
    os.kill(os.getpid(), signal.SIGKILL)
"""


def test_what_a_killed_process_was_writing_is_removed_by_the_next_writer(tmp_path):
    """Of whatever file of the folder; not what a living one, or another machine, is writing."""
    subprocess.run([sys.executable, "-c", KILLED, str(tmp_path / "blade.msh")])
    (left,) = tmp_path.iterdir()
    number, started, machine = left.name.split(".")[2].split("-")
    kept = [
        f".page.{os.getpid()}-{files._started(os.getpid())}-{machine}.html",
        f".page.{number}-{started}-{'0' * 16}.html",
        f".page.{number}.html",
        ".hidden",
    ]
    for name in kept:
        (tmp_path / name).touch()
    with whole(tmp_path / "table.csv") as temporary:
        temporary.touch()
    assert {path.name for path in tmp_path.iterdir()} == {*kept, "table.csv"}


def test_another_process_of_the_same_number_does_not_keep_what_is_left(tmp_path):
    left = tmp_path / f".page.{os.getpid()}-1-{files._machine()}.html"  # since the machine started
    left.touch()
    require_writable(tmp_path / "page.html")
    assert not list(tmp_path.iterdir())


def full_disk(*_):
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def test_a_place_that_cannot_be_written_is_one_line(tmp_path, monkeypatch):
    (tmp_path / "file").touch()
    (tmp_path / "folder.nc").mkdir()
    for path in (tmp_path / "file/out.nc", tmp_path / "folder.nc"):
        fault = rf"^{path}: cannot be written \(.+\); make room .*$"
        with pytest.raises(WriteError, match=fault), whole(path) as temporary:
            temporary.touch()
    monkeypatch.setattr(files.Path, "write_bytes", full_disk)
    error = refused(WriteError, require_writable, tmp_path / "out.nc", match="No space left")
    assert error.file == str(tmp_path / "out.nc")
    assert {path.name for path in tmp_path.iterdir()} == {"file", "folder.nc"}


@pytest.mark.parametrize("places", [0, 1, 3])
def test_a_result_that_cannot_be_written_is_kept_elsewhere(tmp_path, monkeypatch, places):
    """In the folder of temporary files, else at home, else here; the message says where."""
    elsewhere = [tmp_path / name for name in ("temporary", "home", "here")]
    for folder in elsewhere:
        folder.mkdir()
    monkeypatch.setattr(files.tempfile, "gettempdir", lambda: str(elsewhere[0]))
    monkeypatch.setenv("HOME", str(elsewhere[1]))
    monkeypatch.chdir(elsewhere[2])
    tried = []

    def save(path):
        tried.append(path)
        with whole(path) as temporary:
            if len(tried) <= 1 + places:
                full_disk()
            temporary.write_text("result")

    error = refused(WriteError, write_or_keep, save, tmp_path / "out.txt")
    message = str(error)
    assert message.startswith(
        f"{tmp_path / 'out.txt'}: cannot be written (No space left on device)"
    )
    assert len(tried) == 1 + min(places + 1, 3)
    if places < 3:
        kept = message.partition("; the result is in ")[2]
        assert kept.startswith(str(elsewhere[places])) and Path(kept).read_text() == "result"
    left = [path for folder in elsewhere for path in folder.rglob("*") if path.is_file()]
    assert len(left) == (places < 3) and len(list(tmp_path.rglob("tiprub-*"))) == len(left)


def test_json_has_a_hash_of_its_values(tmp_path):
    path, values = tmp_path / "a.json", {"b": [1 / 3, None, "x"], "a": {"2": 1, "10": 2}}
    write_json({**values, "a": {2: 1, 10: 2}}, path)
    assert read_json(path) == values
    text = path.read_text()
    assert set(json.loads(text)) == {"a", "b", "sha256"}
    for broken in (text.replace("0.333", "0.334"), text[:-30], ""):
        path.write_text(broken)
        assert refused(ProvenanceError, read_json, path).file == str(path)
    path.unlink()
    assert refused(ProvenanceError, read_json, path).file == str(path)
    write_json([1, {"a": 2}], path)
    assert read_json(path) == json.loads(path.read_text())["[]"] == [1, {"a": 2}]
    for unknown in ('{"a": 1}', "[1, 2]", "1", "[" * 100_000):
        path.write_text(unknown)
        refused(ProvenanceError, read_json, path)
