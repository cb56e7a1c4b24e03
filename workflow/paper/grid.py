"""||Y|| and Omega_c over Table 1's grid of E and K: Figs. 13a, 13b."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from geometry.project import read_json
from rom.model import Rom
from simulate.scene import Scene
from workflow.paper.cases import ROWS, E, K, of_coating
from workflow.paper.peaks import case

type Case = dict[str, Any]


def of_row(files: Any, scene: Mapping[str, Any], name: str) -> list[Case]:
    """One row of the table, by its name in ``ROWS``, from the files of a rule."""
    return row(Scene.model_validate(scene), Rom.load(files.rom), ROWS[name])


def of_rows(files: Any) -> dict[str, Any]:
    """The table from the files of its rows."""
    return grid([read_json(file) for file in files.rows])


def row(scene: Scene, rom: Rom, young: float) -> list[Case]:
    """Cases of all K of the table at one E."""
    orders = tuple(scene.peaks.orders)
    return [
        {"E": young, "K": plastic} | case(of_coating(scene, young, plastic), rom, orders)
        for plastic in K
    ]


def grid(rows: Iterable[Sequence[Case]]) -> dict[str, Any]:
    """The whole table from its rows."""
    cases = [case for row in rows for case in row]
    orders = sorted({int(k) for case in cases for k in case["peaks"]})
    return {"E": list(E), "K": list(K), "orders": orders, "cases": cases}


def worst(table: dict[str, Any], k: int = 4) -> Case:
    """The case with the highest peak along engine order ``k``."""
    with_peak = [case for case in table["cases"] if case["peaks"][str(k)]]
    return max(with_peak, key=lambda case: case["peaks"][str(k)]["amplitude"])


def at(table: dict[str, Any], young: float, plastic: float) -> Case:
    """The case of one coating."""
    return next(c for c in table["cases"] if (c["E"], c["K"]) == (young, plastic))
