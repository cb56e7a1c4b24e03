import re
from pathlib import Path

import pytest
import yaml

from geometry.blade import Blade
from geometry.settings import check_settings
from simulate.scene import Scene
from workflow.readme import replace_block, settings_table

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text()


@pytest.mark.parametrize(("name", "model"), [("blade", Blade), ("scene", Scene)])
def test_the_tables_of_settings_are_those_of_the_models(name, model):
    assert replace_block(README, name, settings_table(model)) == README


@pytest.mark.parametrize(
    "row",
    [
        "| `integrator.fraction_of_limit` | `central-difference`: Step over the stability limit "
        "with contact | > 0, <= 1 |  |",
        "| `liner.law.E` | `elastic`, `plastic`: Young's modulus (in unit_Pa) "
        "| > 0, <= 1000000000.0 | required |",
        "| `casing.harmonics[].order` | Nodal diameters | >= 0, <= 200 | required |",
        "| `record.samples_per_round` | Samples per round, for spectrum, history and states "
        "| >= 64, <= 1000000 | `2048` |",
    ],
)
def test_a_row_has_meaning_range_and_default(row):
    assert row in settings_table(Scene).splitlines()


def test_what_the_readme_says_a_scene_can_say_is_one():
    """Its lines, put into a scene of ours."""
    (example,) = re.findall(r"```yaml\n(integrator:.*?)```", README, re.DOTALL)
    shown = yaml.safe_load(example)
    scene = yaml.safe_load((ROOT / "workflow/scenes/paper.yaml").read_text())
    liner = scene["liner"] | shown["liner"]
    check_settings(Scene, scene | shown | {"liner": liner}, "README.md")


def test_a_missing_block_is_an_error():
    with pytest.raises(ValueError, match="0 blocks named none"):
        replace_block(README, "none", "")
