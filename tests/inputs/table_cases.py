"""Tables (CSV) of sections, of casings and of designs, changed as people and accidents do."""

from pathlib import Path
from typing import Any

import numpy as np
import yaml
from case import Case
from hypothesis import strategies as st
from scenes import SCENE
from yaml_cases import WORKFLOW, Cases
from yaml_oracle import differ, leaves

from geometry.blade import Blade
from geometry.errors import about
from geometry.settings import check_settings, read_settings
from geometry.table import read_sections
from simulate.design import Design
from simulate.scene import Scene

SECTIONS = (WORKFLOW / "blades/rotor37-sections.csv").read_text()
BLADE = read_settings(Blade, WORKFLOW / "blades/rotor37.yaml").section_table
CHORD = 56.0  # mm, of the sections above
OFF = 0.02 * CHORD * 1e-3  # m: what a station may move without a word
NUMBERS = [
    "1.0D+01",
    "1_0",
    "nan",
    "inf",
    "",
    "x",
    "٣",
    "1,5",
    '"',
    "'1'",
    "1e400",
    "0x1F",
    "1 2",
    "--1",
]


def _points() -> list[int]:
    """Lines of the sections' points, from 0."""
    lines = SECTIONS.split("\n")
    return [i for i, line in enumerate(lines) if line and line[0].isdigit()]


POINTS = _points()


def _sections(folder: Path) -> Any:
    with about("t.csv"):  # as the mesh does
        return read_sections(BLADE, folder / "t.csv")


def _stations(sections: Any) -> np.ndarray:
    return np.array([[s.suction, s.pressure] for s in sections])


def _moved(sections: Any) -> str:
    """How accepted sections differ from those of the unchanged file."""
    found = _stations(sections)
    if found.shape != WHOLE.shape:
        return f"{len(found)} sections of {len(WHOLE)}"
    off = float(np.abs(found - WHOLE).max())
    return f"a station is {1e3 * off:.3g} mm off" if off > OFF else ""


def _table(change: str, text: str | bytes, must: str, fault: Any = _moved) -> Case:
    data = text if isinstance(text, bytes) else text.encode()
    return Case("sections", change, {"t.csv": data}, _sections, must, fault)


def sections() -> Cases:
    """Coordinates of rotor 37: a section or a point moved, numbers in other formats, lost lines."""

    def lines_of(section: int) -> list[int]:
        lines = SECTIONS.split("\n")
        return [i for i in POINTS if lines[i].startswith(f"{section},")]

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
        which, far = draw(st.integers(1, 6)), draw(st.floats(30, 300))
        by = sign * far * np.eye(3)[axis]
        radial = axis == 2  # inside the gap to the next section nobody knows
        must = "either" if radial and (which in (1, 6)) else "refuse"
        fault = (lambda value: "") if must == "either" else _moved
        return _table("section shifted", shifted(lines_of(which), by), must, fault)

    @st.composite
    def spike(draw: st.DrawFn) -> Case:
        i, far = draw(st.sampled_from(POINTS)), draw(st.floats(-60, 60))
        by = far * np.eye(3)[draw(st.integers(0, 2))]
        return _table("point moved", shifted([i], by), "either")

    @st.composite
    def number(draw: st.DrawFn) -> Case:
        lines, i = SECTIONS.split("\n"), draw(st.sampled_from(POINTS))
        cells = lines[i].split(",")
        cells[draw(st.integers(1, 3))] = draw(st.sampled_from(NUMBERS) | st.text(max_size=6))
        lines[i] = ",".join(cells)
        return _table("odd number", "\n".join(lines), "either")

    @st.composite
    def lost(draw: st.DrawFn) -> Case:
        lines = SECTIONS.split("\n")
        first, n = draw(st.sampled_from(POINTS)), draw(st.sampled_from((1, 2, 10, 40, 80)))
        del lines[first : first + n]
        whole = n == 80 and SECTIONS.split("\n")[first].split(",")[0] not in "".join(
            line[:2] for line in lines[POINTS[0] :]
        )
        return _table("lines lost", "\n".join(lines), "either", (lambda v: "") if whole else _moved)

    @st.composite
    def cut(draw: st.DrawFn) -> Case:
        n = draw(st.integers(0, len(SECTIONS) - 2))
        text = SECTIONS[:n]
        last = text.rstrip("\n").split("\n")[-1]
        ends = text.endswith("\n") and POINTS[0] <= text.count("\n") - 1
        next_ = SECTIONS[n:].split("\n")[0]
        between = ends and next_ and next_[0] != last[0]  # a shorter blade, whole
        return _table("cut short", text, "either", (lambda v: "") if between else _moved)

    formats = {
        "byte-order mark": (SECTIONS.encode("utf-8-sig"), "accept"),
        "ends of line of Windows": (SECTIONS.replace("\n", "\r\n").encode(), "accept"),
        "spaces": (SECTIONS.replace(",", " , ").encode(), "accept"),
        "Fortran": (_fortran().encode(), "accept"),
        "semicolons": (SECTIONS.replace(",", ";").encode(), "refuse"),
        "decimal commas": (SECTIONS.replace(",", ";").replace(".", ",").encode(), "refuse"),
        "tabs": (SECTIONS.replace(",", "\t").encode(), "refuse"),
        "UTF-16": (SECTIONS.encode("utf-16"), "refuse"),
        "empty": (b"", "refuse"),
        "binary": (bytes(range(256)), "refuse"),
        "header alone": (b"section,x,y,z\n", "refuse"),
        "no header": (SECTIONS.replace("section,x,y,z\n", "").encode(), "refuse"),
        "columns exchanged": (_columns(1, 3).encode(), "refuse"),
        "quote": (SECTIONS.replace("3,", '"3,', 1).encode(), "refuse"),
        "half of each section": (_half().encode(), "refuse"),
    }
    known = [_table(name, data, must) for name, (data, must) in formats.items()]
    files = [
        Case("sections", f"a {what}", {"t.csv": what}, _sections, "refuse")
        for what in ("folder", "pipe")
    ]
    return st.one_of(section(), spike(), number(), lost(), cut(), st.sampled_from(known + files))


def _columns(*order: int) -> str:
    """The table with two columns of coordinates exchanged, without a change of its header."""
    lines = SECTIONS.split("\n")
    for i in POINTS:
        cells = lines[i].split(",")
        cells[order[0]], cells[order[1]] = cells[order[1]], cells[order[0]]
        lines[i] = ",".join(cells)
    return "\n".join(lines)


def _fortran() -> str:
    lines = SECTIONS.split("\n")
    for i in POINTS:
        name, *place = lines[i].split(",")
        lines[i] = ",".join([name, *(f"{float(x) / 10!r}D+01" for x in place)])
    return "\n".join(lines)


def _half() -> str:
    """The first half of the points of each section."""
    lines = SECTIONS.split("\n")
    by_section: dict[str, list[str]] = {}
    for i in POINTS:
        by_section.setdefault(lines[i][0], []).append(lines[i])
    kept = [line for points in by_section.values() for line in points[: len(points) // 2]]
    return "\n".join(["section,x,y,z", *kept])


WHOLE = np.array(
    [
        [s.suction, s.pressure]
        for s in read_sections(BLADE, WORKFLOW / "blades/rotor37-sections.csv")
    ]
)
ANGLES = [10 * i for i in range(36)]
CASING = "theta_deg,depth_um\n" + "\n".join(f"{a},{20 + a % 70}" for a in ANGLES) + "\n"


def casings() -> Cases:
    """Depths around the casing: lines changed, lost, moved; other columns and units."""

    def read(folder: Path) -> Any:
        values = yaml.safe_load(SCENE)
        values["casing"] = {"ramp_rounds": 0.1, "table": str(folder / "t.csv")}
        return check_settings(Scene, values, "scene.yaml")

    def said(text: str) -> Any:
        rows = [
            line.split(",") for line in text.replace("\ufeff", "").splitlines()[1:] if line.strip()
        ]
        held = [(float(a), float(d.upper().replace("D", "E")) * 1e-6) for a, d in rows if a]

        def fault(scene: Any) -> str:
            table = scene.casing.table
            same = np.allclose(held, np.transpose([table.theta_deg, table.depth_m]), rtol=1e-12)
            return "" if same else "its depths are not those of the file"

        return fault

    def never(text: str) -> Any:
        try:
            return said(text)
        except ValueError:
            return lambda scene: "accepted, but a line holds no two numbers"

    @st.composite
    def line(draw: st.DrawFn) -> Case:
        lines = CASING.split("\n")
        i = draw(st.integers(0, len(lines) - 2))
        new = draw(
            st.sampled_from(["", "x", "1", "1,2,3", "5,1.0D+01", "5,1_0", "5,nan", "-5,1", "370,1"])
            | st.text(max_size=8)
        )
        lines[i] = new
        text = "\n".join(lines)
        return Case("casing", "line changed", {"t.csv": text.encode()}, read, "either", never(text))

    files = {
        "byte-order mark": (CASING.encode("utf-8-sig"), "accept"),
        "ends of line of Windows": (CASING.replace("\n", "\r\n").encode(), "accept"),
        "semicolons": (CASING.replace(",", ";").encode(), "refuse"),
        "UTF-16": (CASING.encode("utf-16"), "refuse"),
        "empty": (b"", "refuse"),
        "another unit": (CASING.replace("_um", "_inch").encode(), "refuse"),
        "no unit": (CASING.replace("depth_um", "um").encode(), "refuse"),
        "radians": (CASING.replace("theta_deg", "theta").encode(), "refuse"),
        "a folder": ("folder", "refuse"),
        "a pipe": ("pipe", "refuse"),
    }
    known = [
        Case("casing", name, {"t.csv": data}, read, must, said(CASING))
        for name, (data, must) in files.items()
    ]
    return line() | st.sampled_from(known)


COLUMNS = ("liner.law.E", "damping_ratio", "rounds", "liner.strips", "casing.harmonics[0].order")
ROWS = [
    ["1.0", "0.004", "2", "8", "2"],
    ["10.0", "0.005", "3", "4", "4"],
    ["2.5", "", "2", "8", "1"],
]


def _said(cell: str) -> str:
    """What a cell says, as it is written."""
    try:
        return str(yaml.load(cell, yaml.BaseLoader))
    except yaml.YAMLError:
        return cell


def designs() -> Cases:
    """Tables of scenes: a cell or a column changed."""
    base = check_settings(Scene, yaml.safe_load(SCENE) | {"design": "t.csv"}, "scene.yaml")

    def read(folder: Path) -> Any:
        return Design.of(base, folder / "scene.yaml")

    def fault_of(rows: list[list[str]]) -> Any:
        def fault(design: Any) -> str:
            if len(design.scenes) != len(rows):
                return f"{len(design.scenes)} rows of {len(rows)}"
            for scene, row in zip(design.scenes, rows, strict=True):
                law, harmonic = scene.liner.law, scene.casing.harmonics[0]
                held = (
                    law.E,
                    scene.damping_ratio,
                    scene.rounds,
                    scene.liner.strips,
                    harmonic.order,
                )
                cells = zip(COLUMNS, row, held, strict=True)
                said = {(name,): _said(cell) for name, cell, _ in cells if cell.strip()}
                cells = zip(COLUMNS, row, held, strict=True)
                found = {name: value for name, cell, value in cells if cell.strip()}
                if wrong := differ(said, leaves(found)):
                    return wrong
            return ""

        return fault

    @st.composite
    def cell(draw: st.DrawFn) -> Case:
        rows = [list(row) for row in ROWS]
        i, j = draw(st.integers(0, 2)), draw(st.integers(0, 4))
        odd = [
            "010",
            "1:30",
            "1_000",
            "nan",
            "[1]",
            "x",
            "-1",
            "1e3",
            "5",
            "!!int 5",
            "&a [*a]",
            "[" * 50,
        ]
        text = st.text(st.characters(exclude_characters=',\n\r;"\t'), max_size=6)
        rows[i][j] = draw(st.sampled_from(odd) | text)
        lines = "\n".join(map(",".join, [list(COLUMNS), *rows]))
        fault = fault_of([row for row in rows if any(cell.strip() for cell in row)])
        return Case("design", "cell changed", {"t.csv": lines.encode()}, read, "either", fault)

    @st.composite
    def column(draw: st.DrawFn) -> Case:
        names, j = list(COLUMNS), draw(st.integers(0, 4))
        names[j] = draw(
            st.sampled_from(
                ["", "blade", "x", "liner", "liner..E", "casing.harmonics[9].order", "rounds.x"]
            )
            | st.text(st.characters(exclude_characters=',\n\r;"\t#'), max_size=8)
        )
        lines = "\n".join(map(",".join, [names, *ROWS]))
        return Case("design", "column changed", {"t.csv": lines.encode()}, read, "refuse")

    return cell() | column()


def table_cases() -> Cases:
    """All of these."""
    return st.one_of(sections(), sections(), casings(), designs())
