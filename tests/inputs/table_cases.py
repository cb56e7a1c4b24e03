"""Tables (CSV) of sections, of casings and of designs, changed as people and accidents do."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import yaml
from case import Case, Content
from changes import cell, contents, cut, lines_lost, long, other_line
from hypothesis import strategies as st
from pydantic import create_model
from scenes import SCENE
from yaml_cases import WORKFLOW, Cases
from yaml_oracle import differ, leaves

from geometry.base import Settings, SettingsError, about, check_settings
from geometry.blade import Blade
from geometry.section_table import read_sections
from simulate.scene import Scene
from simulate.scene.casing_modes import AnyModes
from simulate.scene.laws.table import STRAIN, STRESS, Curve
from simulate.scene.stage import AnyLengths
from simulate.scene.tables import (
    GROWTHS,
    RADII,
    SHIFTS,
    SPEEDS,
    Line,
    Shift,
    Thermal,
    Z,
    from_csv,
)
from workflow.many.design import Design

SECTIONS = (WORKFLOW / "blades/rotor37-sections.csv").read_text()
BLADE = Blade.load(WORKFLOW / "blades/rotor37.yaml").section_table
CHORD = 56.0  # mm, of the sections above
OFF = 0.02 * CHORD * 1e-3  # m: what a station may move without a word
NUMBERS = ["1.0D+01", "1_0", "nan", "inf", "", "x", "٣", "1,5", '"', "'1'", "1e400", "0x1F"]
NUMBERS += ["1 2", "--1"]
POINTS = [i for i, line in enumerate(SECTIONS.split("\n")) if line[:1].isdigit()]


def _sections(folder: Path) -> Any:
    with about("t.csv"):  # as the mesh does
        return read_sections(BLADE, folder / "t.csv")


def _stations(sections: Any) -> np.ndarray:
    return np.array([[s.suction, s.pressure] for s in sections])


WHOLE = _stations(read_sections(BLADE, WORKFLOW / "blades/rotor37-sections.csv"))


def _moved(text: str) -> Callable[[Any], str]:
    """How accepted sections differ from those of the unchanged file that a text still names."""
    named = [f"\n{number}," in text for number in range(1, len(WHOLE) + 1)]

    def fault(sections: Any) -> str:
        if len(sections) != sum(named):
            return f"{len(sections)} sections of {sum(named)}"
        off = float(np.abs(_stations(sections) - WHOLE[named]).max())
        return f"a station is {1e3 * off:.3g} mm off" if off > OFF else ""

    return fault


def _table(change: str, text: str, must: str = "either", data: Content | None = None) -> Case:
    files = {"t.csv": text.encode() if data is None else data}
    return Case("sections", change, files, _sections, must, _moved(text))


def sections() -> Cases:
    """Coordinates of rotor 37: a section or a point moved, numbers in other formats, lost lines."""

    def shifted(chosen: list[int], by: np.ndarray) -> str:
        lines = SECTIONS.split("\n")
        for i in chosen:
            name, *place = lines[i].split(",")
            moved = np.array(place, float) + by
            lines[i] = ",".join([name, *(f"{x:.3f}" for x in moved)])
        return "\n".join(lines)

    @st.composite
    def section(draw: st.DrawFn) -> Case:
        axis, sign = draw(st.integers(0, 2)), draw(st.sampled_from((-1, 1)))
        ends = (1, 4) if axis == 2 else (0, 5)  # how long a blade is nobody knows
        which, far = draw(st.integers(*ends)), draw(st.floats(30, 300))
        rows = POINTS[80 * which : 80 * which + 80]
        return _table("section shifted", shifted(rows, sign * far * np.eye(3)[axis]), "refuse")

    @st.composite
    def spike(draw: st.DrawFn) -> Case:
        i, far = draw(st.sampled_from(POINTS)), draw(st.floats(-60, 60))
        return _table("point moved", shifted([i], far * np.eye(3)[draw(st.integers(0, 2))]))

    lost = lines_lost(SECTIONS, POINTS, 1, 2, 10, 40, 80)
    changed = cell(SECTIONS, POINTS, NUMBERS) | lost | cut(SECTIONS) | long(SECTIONS, POINTS)
    known = contents(SECTIONS) | {
        "spaces": (SECTIONS.replace(",", " , ").encode(), "accept"),
        "semicolons": (SECTIONS.replace(",", ";").encode(), "refuse"),
        "decimal commas": (SECTIONS.replace(",", ";").replace(".", ",").encode(), "refuse"),
        "tabs": (SECTIONS.replace(",", "\t").encode(), "refuse"),
        "header alone": (b"section,x,y,z\n", "refuse"),
        "no header": (SECTIONS.replace("section,x,y,z\n", "").encode(), "refuse"),
        "quote": (SECTIONS.replace("3,", '"3,', 1).encode(), "refuse"),
    }
    files = [_table(name, SECTIONS, must, data) for name, (data, must) in known.items()]
    return st.one_of(section(), spike(), changed.map(lambda c: _table(*c)), st.sampled_from(files))


def _rows(text: str) -> list[list[str]]:
    """Cells of the lines below the header, but for blank ones and comments."""
    lines = (line for line in text.split("\n") if line.strip() and line.lstrip()[0] != "#")
    return [line.split(",") for line in lines][1:]


def _numeric(text: str) -> str:
    return text.upper().replace("D", "E")


ANGLES = [10 * i for i in range(36)]
CASING = "theta_deg,depth_um\n" + "\n".join(f"{a},{20 + a % 70}" for a in ANGLES) + "\n"


def casings() -> Cases:
    """Depths around the casing: lines changed, lost, moved; other columns and units."""

    def read(folder: Path) -> Any:
        values = yaml.safe_load(SCENE)
        values["casing"] = {"ramp_rounds": 0.1, "table": str(folder / "t.csv")}
        return check_settings(Scene, values, "scene.yaml")

    def case(change: str, text: str, must: str = "either", data: Content | None = None) -> Case:
        def fault(scene: Any) -> str:
            try:
                held = [(float(angle), float(depth)) for angle, depth in _rows(_numeric(text))]
            except ValueError:
                return "accepted, but a line holds no two numbers"
            table = scene.casing.table
            same = np.allclose(held, np.transpose([table.theta_deg, table.depth_um]), rtol=1e-12)
            return "" if same else "its depths are not those of the file"

        files = {"t.csv": text.encode() if data is None else data}
        return Case("casing", change, files, read, must, fault)

    odd = ["", "x", "1", "1,2,3", "5,1.0D+01", "5,1_0", "5,nan", "-5,1", "370,1"]
    known = contents(CASING) | {
        "semicolons": (CASING.replace(",", ";").encode(), "refuse"),
        "another unit": (CASING.replace("_um", "_inch").encode(), "refuse"),
        "no unit": (CASING.replace("depth_um", "um").encode(), "refuse"),
        "radians": (CASING.replace("theta_deg", "theta").encode(), "refuse"),
    }
    files = [case(name, CASING, must, data) for name, (data, must) in known.items()]
    changed = other_line(CASING, range(len(ANGLES) + 1), odd) | long(CASING, range(len(ANGLES)))
    return changed.map(lambda change: case(*change)) | st.sampled_from(files)


COLUMNS = ("liner.law.E", "damping_ratio", "rounds", "liner.strips", "casing.harmonics[0].order")
ROWS = [
    ["1.0", "0.004", "2", "8", "2"],
    ["10.0", "0.005", "3", "4", "4"],
    ["2.5", "", "2", "8", "1"],
]


DESIGN = "\n".join(map(",".join, [COLUMNS, *ROWS]))


def _said(cell: str) -> str:
    """What a cell says, as it is written."""
    try:
        return str(yaml.load(cell, yaml.BaseLoader))
    except yaml.YAMLError:
        return cell


def designs() -> Cases:
    """Tables of scenes: a cell or a column changed."""
    base = check_settings(Scene, yaml.safe_load(SCENE) | {"design": "t.csv"}, "scene.yaml")
    keys = [tuple(re.findall(r"\w+", column)) for column in COLUMNS]

    def case(change: str, text: str, must: str) -> Case:
        def fault(design: Any) -> str:
            rows = _rows(text)
            scenes = [row.scene for row in design.rows()]
            if len(scenes) != len(rows):
                return f"{len(scenes)} rows of {len(rows)}"
            for scene, row in zip(scenes, rows, strict=True):
                cells = zip(keys, row, strict=True)
                said = {key: _said(cell) for key, cell in cells if cell.strip()}
                held = {key: value for key, value in leaves(scene).items() if key in said}
                if wrong := differ(said, held):
                    return wrong
            return ""

        def read(folder: Path) -> Any:
            design = Design.of(base, folder / "scene.yaml")
            for row in design.rows():  # a row that is refused stays a row
                if row.refused:
                    raise SettingsError(*row.refused, file=design.path)
            return design

        return Case("design", change, {"t.csv": text.encode()}, read, must, fault)

    odd = ["010", "1:30", "1_000", "nan", "[1]", "x", "-1", "1e3", "5", "!!int 5", "&a [*a]"]
    names = ["", "blade.x", "x", "liner", "liner..E", "casing.harmonics[9].order", "rounds.x"]
    plain = st.text(st.characters(codec="utf-8", exclude_characters=',\n\r;"\t#'), max_size=8)
    cells = cell(DESIGN, [1, 2, 3], [*odd, "[" * 50], plain) | long(DESIGN, [1, 2, 3])
    columns = cell(DESIGN, [0], names, plain)
    return cells.map(lambda c: case(*c, "either")) | columns.map(lambda c: case(*c, "refuse"))


TABLES = {  # by the model of the table: header and rows; readers, columns and units as of casings
    Thermal: (SPEEDS, GROWTHS, "speed_rpm,growth_um\n0,0\n3000,12.5\n6000,40\n"),
    Shift: (SPEEDS, SHIFTS, "speed_over_f1,shift_um\n0,0\n0.2,-12.5\n0.4,40\n"),
    Line: (Z, RADII, "z_mm,r_mm\n-20,250\n10,240.5\n80,230\n"),
    Curve: (STRAIN, STRESS, "strain,stress_MPa\n0,0\n0.1,30\n0.5,70\n"),
}


def other_tables() -> Cases:
    """Growth, shift, shape of the casing and curve of a law: cells and lines changed."""

    def case(model: type, change: str, text: str, must: str = "either") -> Case:
        of_file = from_csv(model, *TABLES[model][:2])

        def read(folder: Path) -> Any:
            holder = create_model("Scene", __base__=Settings, table=Annotated[model, of_file])
            return check_settings(holder, {"table": folder / "t.csv"}, "scene.yaml").table

        def fault(table: Any) -> str:
            held = [[float(cell) for cell in row] for row in _rows(_numeric(text))]
            columns = [column for _, column in table if column is not None]
            return "" if np.array_equal(np.transpose(columns), held) else "holds other numbers"

        return Case("table", change, {"t.csv": text.encode()}, read, must, fault)

    def of(model: type) -> Cases:
        text, rows = TABLES[model][2], [1, 2, 3]
        changed = cell(text, rows, NUMBERS) | long(text, [0, *rows]) | cut(text)
        return changed.map(lambda change: case(model, *change))

    return st.sampled_from(sorted(TABLES, key=str)).flatmap(of)


MODES = """order,frequency_Hz,modal_mass_kg,radial,damping_ratio
0,900,20,,0.01
2,400,,0.3,0.005
3,700.5,9,,0
"""


def _list(kind: Any, said: Callable[[str], list[Any]], change: str, text: str) -> Case:
    """A CSV file of a list of a ``kind``, which should hold what is ``said``."""

    def read(folder: Path) -> Any:
        holder = create_model("Scene", __base__=Settings, table=kind)
        return check_settings(holder, {"table": folder / "t.csv"}, "scene.yaml").table

    def fault(table: Any) -> str:
        held = [
            of.model_dump(exclude_unset=True) if isinstance(of, Settings) else of for of in table
        ]
        return "" if held == said(text) else "holds other numbers"

    return Case("table", change, {"t.csv": text.encode()}, read, "either", fault)


def modes() -> Cases:
    """Modes of a casing: cells, lines and columns changed."""

    def said(text: str) -> list[Any]:
        names = [name.strip() for name in text.split("\n")[0].split(",")]
        rows = _rows(_numeric(text))
        return [
            {name: float(of) for name, of in zip(names, row, strict=True) if of.strip()}
            for row in rows
        ]

    rows, names = [1, 2, 3], ["", "order", "Hz", "axial", "frequency_hz", "damping_ratio "]
    changed = cell(MODES, rows, NUMBERS) | long(MODES, [0, *rows]) | cut(MODES)
    changed |= cell(MODES, [0], names)
    return changed.map(lambda change: _list(AnyModes, said, *change))


def lengths() -> Cases:
    """Lengths of the blades of a stage, one column: cells and lines changed."""

    def said(text: str) -> list[Any]:
        return [float(row[0]) for row in _rows(_numeric(text))]

    text, rows = "longer_um\n2.5\n0\n-3\n", [1, 2, 3]
    changed = cell(text, rows, NUMBERS) | long(text, [0, *rows]) | cut(text)
    changed |= cell(text, [0], ["", "um", "longer_in"])
    return changed.map(lambda change: _list(AnyLengths, said, *change))


def table_cases() -> Cases:
    """All of these."""
    return st.one_of(
        sections(), sections(), casings(), designs(), other_tables(), modes(), lengths()
    )
