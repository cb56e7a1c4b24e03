"""workflow/config.yaml and --config: one strict reader, each fault of the right source."""

import subprocess
from errno import ENOSPC
from pathlib import Path
from unittest.mock import Mock

import pytest
from projects import make_project
from refused import refused

from geometry.base import SettingsError
from workflow import at_work
from workflow.at_work import not_writable
from workflow.config import Config, read_config

SCENES = ("paper-e1", "paper-e10")
TEXT = "scenes: [paper-e1]\nblocks: 2\n"


@pytest.fixture
def read(tmp_path):
    """Read a text with values of the command line."""

    def read(text=TEXT, given=None):
        (tmp_path / "config.yaml").write_text(text)
        return read_config(tmp_path / "config.yaml", given, SCENES)

    return read


def test_the_project_has_a_valid_one():
    assert read_config(Path(__file__).parents[2] / "workflow/config.yaml").blocks > 0


def test_the_command_line_replaces_the_file(read):
    given = {"scenes": ["paper-e10"], "blocks": 5}
    assert read(given=given) == Config(scenes=["paper-e10"], blocks=5)
    assert read(given={}) == read() == Config(scenes=["paper-e1"], blocks=2)


@pytest.mark.parametrize(
    ("text", "key", "value", "line"),
    [
        (TEXT + "blocks: 3", "", None, 3),  # twice
        ("", "", None, None),
        ("scenes: [a", "", None, 1),
        ("scenes: [[paper-e1]]\nblocks: 1", "scenes.0", ["paper-e1"], 1),
        (TEXT.replace("2", "0"), "blocks", 0, 2),
        (TEXT.replace("2", "010"), "", None, 2),  # octal in YAML
        (TEXT.replace("e1", "e11"), "scenes", "paper-e11", None),
        (TEXT.replace("paper-e1", "../scenes/paper-e1"), "scenes", "../scenes/paper-e1", None),
        (TEXT + "explore: [x]", "explore", "x", None),
    ],
)
def test_a_fault_of_the_file_has_its_key_value_and_line(read, text, key, value, line):
    error = refused(SettingsError, read, text)
    assert Path(error.file).name == "config.yaml"
    assert (error.key, error.value, error.line) == (key, value, line)


@pytest.mark.parametrize(
    ("given", "key", "value", "allowed"),
    [
        ({"blocks": 0}, "blocks", 0, {"ge": 1}),
        ({"block": 3}, "block", None, ["blocks"]),
        ({"scenes": "paper-e1"}, "scenes", "paper-e1", None),
        ({"scenes": ["../x"]}, "scenes", "../x", None),
    ],
)
def test_a_fault_of_the_command_line_has_its_key_value_and_what_is_allowed(
    read, given, key, value, allowed
):
    error = refused(SettingsError, read, TEXT, given)
    assert error.file == "--config"
    assert (error.key, error.value, error.allowed) == (key, value, allowed)


def test_a_folder_without_room_or_rights_is_named(tmp_path, monkeypatch):
    assert not not_writable(tmp_path)
    none = tmp_path / "none"
    assert not_writable(none).startswith(f"{none}: cannot be written (No such file")
    full = Mock(side_effect=OSError(ENOSPC, "No space left on device"))
    monkeypatch.setattr(at_work, "TemporaryFile", full)
    assert "(No space left on device): make room there" in not_writable(tmp_path)


def test_a_run_without_a_temporary_folder_ends_in_one_line(tmp_path, monkeypatch):
    """Snakemake would have a traceback of its scheduler."""
    project = make_project(tmp_path)
    monkeypatch.setenv("TMPDIR", "/none")
    done = subprocess.run(
        project.command("-n"), cwd=tmp_path, env=project.environment, capture_output=True, text=True
    )
    said = done.stdout + done.stderr
    assert done.returncode == 1 and "Traceback" not in said
    assert "/none: cannot be written (No such file or directory)" in said
    assert "or set TMPDIR" in said
