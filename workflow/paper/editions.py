"""Numbers of the claims by edition: of repeats, of choices made otherwise, of another blade.

The first name of a row of an experiment is that of its edition, its label that of the part.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from geometry.project import read_json
from rom.model import Rom
from simulate.scene import Scene
from workflow.paper import measure
from workflow.paper.grid import growth, long_cases, of_rows, worst
from workflow.paper.measure import Numbers

type Rows = Sequence[Mapping[str, Any]]  # of the table of an experiment


def editions(table: str, growth: str = "", model: str = "") -> dict[str, Numbers]:
    """Numbers of all editions in the table of an experiment.

    ``growth``: file of ``growth_of`` the same table; ``model``: of the reduced models.
    """
    of_model = read_json(model) if model else {}
    found = numbers_of(read_json(table), read_json(growth) if growth else {})
    return {name: numbers | of_model for name, numbers in found.items()}


def numbers_of(rows: Rows, long: Mapping[str, Any]) -> dict[str, Numbers]:
    """Numbers by edition and by part; ``long``: ``growth_of`` the same rows.

    Of the coatings they are those of their table, as far as they have peaks.
    """
    return {
        name: _parts(of) | _long(of, long.get(name, [])) for name, of in _by_edition(rows).items()
    }


def growth_of(table: Rows) -> dict[str, Any]:
    """Long runs of each edition with the table of E and K; None where a coating has no peak."""
    return {
        name: [
            growth(
                Scene.model_validate(row["settings"]), Rom.load(row["rom"]), long, row["numbers"]
            )
            for long, row in _long_rows(of).items()
        ]
        or None
        for name, of in _by_edition(table).items()
        if any(row["scene"] == "grid" for row in of)
    }


def _by_edition(rows: Rows) -> dict[str, list[Mapping[str, Any]]]:
    found: dict[str, list[Mapping[str, Any]]] = {}
    for row in rows:
        found.setdefault(row["names"][0], []).append(row)
    return found


def _long_rows(rows: Rows) -> dict[str, Mapping[str, Any]]:
    """Rows of the coatings whose growth is followed, by name."""
    of = {(row["numbers"]["E"], row["numbers"]["K"]): row for row in rows if row["scene"] == "grid"}
    return {name: of[case["E"], case["K"]] for name, case in long_cases(of_rows(rows)).items()}


def _parts(rows: Rows) -> Numbers:
    """Numbers by part; of the coatings those of their table."""
    numbers = {
        row["scene"]: row["numbers"] for row in rows if row["scene"] not in ("grid", "rigid")
    }
    coatings = of_rows(rows)
    return numbers | ({"grid": measure.table(coatings)} if worst(coatings) else {})


def _long(rows: Rows, cases: Sequence[Mapping[str, Any]] | None) -> Numbers:
    """Growth, and the peak of the bare casing, where there is one."""
    bare = [row["numbers"] for row in rows if row["scene"] == "rigid"]
    known = bare and cases is not None
    return {"long": measure.long_run(bare[0], cases)} if known else {}
