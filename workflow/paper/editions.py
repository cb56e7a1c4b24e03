"""Numbers of the claims by edition: of repeats, of choices made otherwise, of another blade.

The first name of a row of an experiment is that of its edition, its label that of the part.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from geometry.project import read_json
from rom.model import Rom
from simulate.scene import Scene
from workflow.paper import measure
from workflow.paper.grid import of_rows
from workflow.paper.measure import Numbers
from workflow.paper.worst import growth, long_cases

type Rows = Sequence[Mapping[str, Any]]  # of the table of an experiment


def editions(table: str, growth: str = "", model: str = "") -> dict[str, Numbers]:
    """Numbers of all editions in the table of an experiment.

    ``growth``: file of ``grown`` of the same table; ``model``: of the reduced models.
    """
    of_growth = read_json(growth) if growth else {}
    of_model = read_json(model) if model else {}
    return {
        name: _parts(rows) | _long(rows, of_growth.get(name, [])) | of_model
        for name, rows in _by_edition(read_json(table)).items()
    }


def grown(files: Any) -> dict[str, Any]:
    """Long runs of each edition in ``files.table`` that has the table of E and K."""
    return {
        name: [
            growth(
                Scene.model_validate(row["settings"]), Rom.load(row["rom"]), long, row["numbers"]
            )
            for long, row in _long_rows(rows).items()
        ]
        for name, rows in _by_edition(read_json(files.table)).items()
    }


def _by_edition(rows: Rows) -> dict[str, list[Mapping[str, Any]]]:
    found: dict[str, list[Mapping[str, Any]]] = {}
    for row in rows:
        found.setdefault(row["names"][0], []).append(row)
    return found


def _long_rows(rows: Rows) -> dict[str, Mapping[str, Any]]:
    """Rows of the coatings whose growth is followed, by name."""
    of = {(row["numbers"]["E"], row["numbers"]["K"]): row for row in rows if row["scene"] == "grid"}
    long = long_cases(of_rows(rows)) if of else {}
    return {name: of[case["E"], case["K"]] for name, case in long.items()}


def _parts(rows: Rows) -> Numbers:
    """Numbers by part; of the coatings those of their table."""
    numbers = {
        row["scene"]: row["numbers"] for row in rows if row["scene"] not in ("grid", "rigid")
    }
    if any(row["scene"] == "grid" for row in rows):
        numbers["grid"] = measure.table(of_rows(rows))
    return numbers


def _long(rows: Rows, cases: Sequence[Mapping[str, Any]]) -> Numbers:
    """Growth, and the peak of the bare casing, where there is one."""
    bare = [row["numbers"] for row in rows if row["scene"] == "rigid"]
    return {"long": measure.long_run(bare[0], cases)} if bare else {}
