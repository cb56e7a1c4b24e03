"""workflow/config.yaml and --config: one strict reader, each fault of the right source."""

from pathlib import Path

import pytest

from geometry.errors import SettingsError
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
    ("text", "given", "message"),
    [
        (
            TEXT + "blocks: 3",
            None,
            "config.yaml: is not YAML: key 'blocks' is given twice (line 3)",
        ),
        ("", None, "config.yaml: holds no 'key: value' lines"),
        ("scenes: [a", None, "config.yaml: is not YAML: while parsing a flow sequence"),
        ("scenes: [[paper-e1]]\nblocks: 1", None, "config.yaml: scenes.0: ['paper-e1']: should be"),
        (TEXT.replace("2", "0"), None, "config.yaml: blocks: 0: should be greater than or equal"),
        (TEXT.replace("2", "010"), None, "config.yaml: '010': is read by YAML as octal"),
        (
            TEXT.replace("e1", "e11"),
            None,
            "config.yaml: scenes: 'paper-e11': no workflow/scenes/paper-e11.yaml; did you mean "
            "'paper-e1",
        ),
        (
            TEXT.replace("paper-e1", "../scenes/paper-e1"),
            None,
            "config.yaml: scenes: '../scenes/paper-e1': no name of a scene; a name has letters",
        ),
        (TEXT + "explore: [x]", None, "config.yaml: explore: 'x': no workflow/scenes/x.yaml"),
        (TEXT, {"blocks": 0}, "--config: blocks: 0: should be greater than or equal to 1"),
        (TEXT, {"block": 3}, "--config: block: unknown key; did you mean 'blocks'?"),
        (
            TEXT,
            {"scenes": "paper-e1"},
            "--config: scenes: 'paper-e1': should be a valid list; a list has brackets, as in [",
        ),
        (TEXT, {"scenes": ["../x"]}, "--config: scenes: '../x': no name of a scene"),
    ],
)
def test_a_fault_is_one_line_of_its_source(read, text, given, message):
    with pytest.raises(SettingsError) as caught:
        read(text, given)
    assert str(caught.value).split("/", 5)[-1].split("/")[-1].startswith(message) or message in str(
        caught.value
    )
    assert "\n" not in str(caught.value)
