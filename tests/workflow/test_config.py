"""workflow/config.yaml and --config: one strict reader, each fault of the right source."""

from pathlib import Path

import pytest
from refused import refused

from geometry.project import SettingsError
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
