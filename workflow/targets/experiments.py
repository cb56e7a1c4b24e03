"""Experiments of a project: the files, code and settings of their jobs."""

from collections.abc import Iterable
from itertools import chain
from typing import Any

from geometry.base import SettingsError
from simulate.scene import fault_of_blade
from workflow.many.plan import Experiment, cases
from workflow.many.row import Row
from workflow.targets.blades import Blades
from workflow.targets.inputs import Once, Told, code_of, with_laws


class Experiments:
    """The experiments of ``workflow/experiments``, on the ``blades``, in ``most_blocks``."""

    def __init__(self, blades: Blades, most_blocks: int) -> None:
        self.blades, self.most_blocks = blades, most_blocks
        self.cases = Once[list[Row]]((), self._cases)  # by the name of the experiment

    def rows(self, wildcards: Any) -> list[Row]:
        """Its rows on their scenes."""
        return self.cases[wildcards.experiment]

    def models(self, wildcards: Any) -> list[str]:
        """Reduced models of the rows that are marched, and the files that numbers need."""
        return _different(file for row in self.rows(wildcards) for file in map(row.file, row.needs))

    def checks(self, wildcards: Any) -> list[str]:
        """Checks of the models: nothing is marched on one that misses its tolerance."""
        return _different(
            row.file("check")
            for row in self.rows(wildcards)
            if "rom" in row.needs and row.scene.blade not in self.blades.foreign
        )

    def models_of_growth(self, wildcards: Any) -> list[str]:
        """Models of the coatings whose table an experiment has."""
        return _different(row.file("rom") for row in self.rows(wildcards) if row.label == "grid")

    def code(self, wildcards: Any) -> list[str]:
        """The engine, and the functions of all rows."""
        named = {of for row in self.rows(wildcards) for of in (row.function, row.model) if of}
        return code_of("experiment_block", *sorted(named))(wildcards)

    def contents(self, wildcards: Any) -> Told:
        """Hashes of the files of the laws of one's own in its rows."""
        laws = (row.scene.liner.law.code_files.items() for row in self.rows(wildcards))
        return with_laws({}, dict(chain(*laws)))

    def plan(self, wildcards: Any) -> Told:
        """All rows, and the number of blocks."""
        return Told(
            {
                "cases": [row.model_dump(mode="json") for row in self.rows(wildcards)],
                "blocks": len(self.blocks(wildcards)),
            }
        )

    def blocks(self, wildcards: Any) -> list[str]:
        """The files of its blocks, at most one for each row."""
        count = min(self.most_blocks, len(self.rows(wildcards)))
        folder = f"results/experiments/{wildcards.experiment}"
        return [f"{folder}/block-{block}.json" for block in range(count)]

    def picture(self, wildcards: Any) -> Told:
        """What is drawn of the table."""
        path = f"workflow/experiments/{wildcards.experiment}.yaml"
        picture = Experiment.load(path).picture
        if picture is None:
            raise SettingsError(f"{path}: picture: missing: give lines or cells")
        return Told(picture.model_dump(mode="json", exclude_none=True))

    def _cases(self, name: str) -> list[Row]:
        """Rows of an experiment; refused where their blade does not allow them."""
        path = f"workflow/experiments/{name}.yaml"
        found = cases(path)
        for row in found:
            of = f"{path}: {row.row}, {row.label}"
            if fault := fault_of_blade(row.scene, self.blades.require(row.scene.blade, of)):
                raise SettingsError(f"{of}: {fault}")
        return found


def _different(files: Iterable[str]) -> list[str]:
    return list(dict.fromkeys(files))
