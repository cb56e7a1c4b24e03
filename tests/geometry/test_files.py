import os

import pytest

from geometry.files import whole


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
def test_failure_leaves_the_folder_as_it_was(tmp_path, before, stop):
    target = tmp_path / "blade.msh"
    if before:
        target.write_text(before)
    with pytest.raises(stop), whole(target) as temporary:
        temporary.write_text("half")
        raise stop
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == (
        {"blade.msh": before} if before else {}
    )


def test_failure_before_anything_is_written(tmp_path):
    with pytest.raises(ValueError), whole(tmp_path / "blade.msh"):
        raise ValueError
    assert not list(tmp_path.iterdir())


def test_two_processes_do_not_share_a_temporary_name(tmp_path, monkeypatch):
    with whole(tmp_path / "a") as first:
        first.touch()
        monkeypatch.setattr(os, "getpid", lambda: 1)
        with whole(tmp_path / "a") as second:
            second.touch()
            assert second != first
