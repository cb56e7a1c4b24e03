from pathlib import Path

import pytest

from geometry.blade import Blade
from simulate.scene import Scene
from workflow.readme import replace_block, settings_table

README = (Path(__file__).parents[2] / "README.md").read_text()


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


def test_a_missing_block_is_an_error():
    with pytest.raises(ValueError, match="0 blocks named none"):
        replace_block(README, "none", "")
