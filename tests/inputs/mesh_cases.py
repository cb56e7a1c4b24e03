"""Meshes, CAD files and parameters that are meshed, changed as people and accidents change them."""

import tempfile
import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import exports
import numpy as np
from blades import given as changed
from case import Case
from hypothesis import strategies as st
from yaml_cases import WORKFLOW, Cases

from geometry.blade import Blade
from geometry.errors import MeshWarning
from geometry.mesh import build_mesh
from geometry.profile import profile_at
from geometry.settings import read_settings

SAME = 1e-6  # relative, of volumes of one mesh: files hold some nine digits
CLOSE = 5e-3  # of a mesh against the closed form of its blade, as coarse as it is
# a rule of degree 3 on a tetrahedron: barycentric coordinates and weights of its points
POINTS = np.full((5, 4), 1 / 6)
POINTS[0], POINTS[1:][np.diag_indices(4)] = 1 / 4, 1 / 2
WEIGHTS = np.array([-4, 2.25, 2.25, 2.25, 2.25]) / 30
ENDS = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))  # of the edges, in the order of the nodes


@cache
def coarse() -> Blade:
    """The reference blade on 768 cells."""
    blade = read_settings(Blade, WORKFLOW / "blades/reference.yaml")
    return blade.but(mesh__element_size_mm=10.0, interface__patches=8)


@cache
def files() -> dict[str, str]:
    """Its mesh in the formats of other programs."""
    with tempfile.TemporaryDirectory() as folder:
        mesh = Path(folder) / "blade.msh"
        build_mesh(coarse(), mesh)
        parts = exports.parts(mesh)
        for name, write in {
            "b.inp": exports.write_inp,
            "b.bdf": exports.write_bdf,
            "b.vtu": exports.write_vtu,
            "b.msh": exports.write_msh,
        }.items():
            write(Path(folder) / name, *parts)
        names = ("b.inp", "b.bdf", "b.vtu", "b.msh")
        return {name: (Path(folder) / name).read_text(errors="surrogateescape") for name in names}


GROUPS = {
    "b.inp": ("ROOT", "TIP"),
    "b.bdf": ("nastran:ref=2", "nastran:ref=3"),
    "b.vtu": ("root", "tip"),
    "b.msh": ("root", "tip"),
}


@cache
def volume() -> float:
    """Volume of the unchanged mesh, m3."""
    return numpy_volume(files()["b.inp"])


def numpy_volume(deck: str) -> float:
    """Volume, m3, of the ten-node cells of a deck in our own format, read line by line.

    The determinant of a cell is a polynomial of degree 3: the rule is exact.
    """
    nodes, cells, of = {}, {}, None
    for line in deck.splitlines():
        if line.startswith("*"):
            of = nodes if line.upper().startswith("*NODE") else None
            of = cells if line.upper().startswith("*ELEMENT") else of
        elif of is not None and line.strip():
            number, *values = line.upper().replace("D", "E").split(",")
            of.setdefault(int(number), [float(value) for value in values])
    at = {number: place for number, place in nodes.items()}
    points = np.array([[at[int(i)] for i in cell] for cell in cells.values()]) * 1e-3
    jacobians = np.einsum("pna,cni->pcai", gradients(), points)
    return float(WEIGHTS @ np.linalg.det(jacobians).sum(axis=1))


def gradients() -> np.ndarray:
    """Of the ten shape functions at the points of the rule, by coordinates 1 to 3: (5, 10, 3)."""
    by_each = np.zeros((len(POINTS), 10, 4))  # by all four, as if they were free
    by_each[:, range(4), range(4)] = 4 * POINTS - 1  # of L (2 L - 1)
    for node, (a, b) in enumerate(ENDS, 4):  # of 4 La Lb
        by_each[:, node, a], by_each[:, node, b] = 4 * POINTS[:, b], 4 * POINTS[:, a]
    return by_each[:, :, 1:] - by_each[:, :, :1]


def build(file: str, root: Any = None, **keys: Any) -> Callable[[Path], Any]:
    """Mesh of a blade from a file in a folder."""

    def read(folder: Path) -> Any:
        groups = (root, 562.3) if root else GROUPS[file]
        blade = exports.as_meshed(coarse(), file, *groups, **keys)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", MeshWarning)  # a fault that is told is not silent
            return build_mesh(blade, folder / "blade.msh", folder / file)

    return read


def of_volume(expected: Callable[[], float], close: float = SAME) -> Callable[[Any], str]:
    """Fault of a mesh whose volume is not as expected."""

    def fault(summary: Any) -> str:
        try:
            off = summary.volume / expected() - 1
        except (ValueError, KeyError, IndexError) as error:
            return f"accepted, but cannot be read: {type(error).__name__} {error}"
        return "" if abs(off) < close else f"its volume is {100 * off:.2g} % off"

    return fault


def _case(change: str, text: str | bytes, must: str, file: str = "b.inp", **keys: Any) -> Case:
    data = text if isinstance(text, bytes) else text.encode(errors="surrogateescape")
    own = file == "b.inp" and isinstance(text, str)
    expected = (lambda: numpy_volume(text)) if own else volume
    return Case("mesh", change, {file: data}, build(file, **keys), must, of_volume(expected))


def decks() -> Cases:
    """A deck: lines, numbers and nodes lost, changed or there twice."""

    def rows(of: str) -> list[int]:
        lines = files()["b.inp"].split("\n")
        cards = [i for i, line in enumerate(lines) if line.startswith("*")] + [len(lines) - 1]
        first = next(i for i in cards if lines[i].startswith(of))
        return list(range(first + 1, cards[cards.index(first) + 1]))

    @st.composite
    def moved(draw: st.DrawFn) -> Case:
        lines, i = files()["b.inp"].split("\n"), draw(st.sampled_from(rows("*NODE")))
        number, *place = lines[i].split(",")
        far = draw(st.sampled_from((0.01, 0.5, 5.0, 50.0, 1e4)))
        axis, sign = draw(st.integers(0, 2)), draw(st.sampled_from((-1, 1)))
        place[axis] = f"{float(place[axis]) + sign * far!r}"
        lines[i] = ",".join([number, *place])
        return _case("node moved", "\n".join(lines), "refuse" if far >= 50 else "either")

    @st.composite
    def cell(draw: st.DrawFn) -> Case:
        of = draw(st.sampled_from(("*NODE", "*ELEMENT")))
        lines, i = files()["b.inp"].split("\n"), draw(st.sampled_from(rows(of)))
        cells = lines[i].split(",")
        odd = ["", "x", "1_0", "nan", "1.0D+01", "-1", "0", "999999", "1", "٣", "1e400", "1" * 5000]
        cells[draw(st.integers(0, len(cells) - 1))] = draw(st.sampled_from(odd))
        lines[i] = ",".join(cells)
        return _case("odd number", "\n".join(lines), "either")

    @st.composite
    def line(draw: st.DrawFn) -> Case:
        of = draw(st.sampled_from(("*NODE", "*ELEMENT")))
        lines, i = files()["b.inp"].split("\n"), draw(st.sampled_from(rows(of)))
        how = draw(st.sampled_from(("lost", "twice", "cut")))
        if how == "lost":
            lines.pop(i)
        elif how == "twice":
            lines.insert(i, lines[i])
        else:
            lines[i] = lines[i][: draw(st.integers(1, len(lines[i]) - 1))]
        return _case(f"line {how}", "\n".join(lines), "accept" if how == "twice" else "either")

    @st.composite
    def twice(draw: st.DrawFn) -> Case:
        lines = files()["b.inp"].split("\n")
        nodes, elements = rows("*NODE"), rows("*ELEMENT")
        of = draw(st.sampled_from((nodes, elements)))
        i, j = draw(st.permutations(of).map(lambda p: p[:2]))
        lines[i] = ",".join([lines[j].split(",")[0], *lines[i].split(",")[1:]])
        return _case("number twice", "\n".join(lines), "refuse")

    @st.composite
    def cut(draw: st.DrawFn) -> Case:
        text = files()["b.inp"]
        by = draw(st.sampled_from((None, 422.5)))  # root by its group, or by radius
        keys = {"root": by} if by else {}
        n = draw(st.integers(0, len(text) - 2))
        if by:  # within the elements
            n = draw(st.integers(text.index("*ELEMENT"), text.index("*NSET, NSET=root") - 1))
        whole = n >= len(text.rstrip(",\n"))  # all numbers are there
        must = "either" if by else "accept" if whole else "refuse"
        return _case("cut short", text[:n], must, **keys)

    @st.composite
    def card(draw: st.DrawFn) -> Case:
        lines = files()["b.inp"].split("\n")
        i = draw(st.sampled_from([i for i, line in enumerate(lines) if line.startswith("*")]))
        new = draw(
            st.sampled_from(
                ["", "*", "*NODE", "*ELEMENT", "*NSET", "*ELEMENT, TYPE=C3D4", "*ELSET, ELSET=x"]
            )
            | st.text(max_size=8)
        )
        lines[i] = new
        return _case("card changed", "\n".join(lines), "either")

    @st.composite
    def comma(draw: st.DrawFn) -> Case:
        lines = files()["b.inp"].split("\n")
        cards = [i for i, line in enumerate(lines) if line.startswith("*")]
        for i in draw(st.lists(st.sampled_from(cards), min_size=1)):
            lines[i] = lines[i].rstrip(", ") + draw(st.sampled_from((",", ", ", " ,  ")))
        return _case("comma at the end of a card", "\n".join(lines).encode(), "accept")

    @st.composite
    def unmerged(draw: st.DrawFn) -> Case:
        lines, i = files()["b.inp"].split("\n"), draw(st.sampled_from(rows("*ELEMENT")))
        cells = lines[i].split(", ")
        others = {node for j in rows("*ELEMENT") if j != i for node in lines[j].split(", ")[1:]}
        at = draw(st.sampled_from([k for k in range(1, 11) if cells[k] in others]))
        nodes = rows("*NODE")
        place = lines[nodes[int(cells[at]) - 1]].split(",")[1:]
        cells[at] = "99999"
        lines[i] = ", ".join(cells)
        lines.insert(nodes[-1] + 1, ",".join(["99999", *place]))
        return _case("node not merged", "\n".join(lines), "refuse")

    @st.composite
    def member(draw: st.DrawFn) -> Case:
        lines = files()["b.inp"].rstrip().split("\n")
        number = draw(st.integers(len(rows("*NODE")) + 1, 10**9))
        first = next(i for i, line in enumerate(lines) if line.startswith("*NSET"))
        lines.insert(draw(st.integers(first + 1, len(lines))), f"{number},")
        return _case("member that is not there", "\n".join(lines), "refuse")

    return moved() | cell() | line() | twice() | cut() | card() | comma() | unmerged() | member()


def formats() -> Cases:
    """All formats: other encodings, numbers of Fortran, files cut short, wrong units and frames."""

    @st.composite
    def cut(draw: st.DrawFn) -> Case:
        file = draw(st.sampled_from(("b.bdf", "b.vtu", "b.msh")))
        text = files()[file]
        n = draw(st.integers(0, int(0.98 * len(text))))
        return _case("cut short", text[:n].encode(errors="surrogateescape"), "refuse", file)

    @st.composite
    def line(draw: st.DrawFn) -> Case:
        file = draw(st.sampled_from(("b.bdf", "b.vtu", "b.msh")))
        lines = files()[file].split("\n")
        i = draw(st.integers(0, len(lines) - 2))
        how = draw(st.sampled_from(("lost", "twice")))
        lines[i : i + 1] = [] if how == "lost" else [lines[i]] * 2
        text = "\n".join(lines).encode(errors="surrogateescape")
        return _case(f"line {how}", text, "either", file)

    @st.composite
    def known(draw: st.DrawFn) -> Case:
        deck, bulk = files()["b.inp"], files()["b.bdf"]
        cases = [
            ("byte-order mark", deck.encode("utf-8-sig"), "accept", "b.inp"),
            ("ends of line of Windows", deck.replace("\n", "\r\n").encode(), "accept", "b.inp"),
            ("Latin-1", b"** \xfc\n" + deck.encode(), "accept", "b.inp"),
            ("small letters", deck.lower().encode(), "accept", "b.inp"),
            ("Fortran", _fortran(deck).encode(), "accept", "b.inp"),
            ("Fortran", _fortran_bulk(bulk).encode(), "accept", "b.bdf"),
            ("number twice", _grid_twice(bulk).encode(), "refuse", "b.bdf"),
            ("continued by blanks", bulk.replace("\n+", "\n ").encode(), "accept", "b.bdf"),
            ("no marks", bulk.replace("+\n+", "\n ").encode(), "accept", "b.bdf"),
            ("END BULK", bulk.replace("ENDDATA", "END BULK").encode(), "accept", "b.bdf"),
            ("no BEGIN BULK", bulk.replace("BEGIN BULK\n", "").encode(), "accept", "b.bdf"),
            ("no ENDDATA", bulk.replace("ENDDATA", "").encode(), "refuse", "b.bdf"),
            ("INCLUDE", bulk.replace("ENDDATA", "INCLUDE a.bdf").encode(), "refuse", "b.bdf"),
            ("syntax of Abaqus", deck.encode(), "refuse", "b.msh"),
            ("flat", _flat(deck).encode(), "refuse", "b.inp"),
            ("assembly", _assembly(deck).encode(), "accept", "b.inp"),
            ("empty", b"", "refuse", "b.inp"),
            ("empty", b"", "refuse", "b.bdf"),
            ("empty", b"", "refuse", "b.vtu"),
            ("empty", b"", "refuse", "b.msh"),
            ("binary", bytes(range(256)) * 9, "refuse", "b.msh"),
            ("binary", bytes(range(256)) * 9, "refuse", "b.inp"),
            (
                "another format",
                files()["b.msh"].encode(errors="surrogateescape"),
                "refuse",
                "b.inp",
            ),
            ("unchanged", deck.encode(), "accept", "b.inp"),
        ]
        change, data, must, file = draw(st.sampled_from(cases))
        return _case(change, data, must, file)

    @st.composite
    def settings(draw: st.DrawFn) -> Case:
        units = [{"unit": unit} for unit in ("m", "cm", "in")]
        frames = [
            {"frame": {"downstream": down, "radial": radial}}
            for down in ("x", "-x", "y", "-y", "z", "-z")
            for radial in ("x", "-x", "y", "-y", "z", "-z")
            if down[-1] != radial[-1] and (down, radial) != ("z", "x")
        ]
        keys = draw(st.sampled_from([*units, *frames, {"frame": {"rotation": "left-handed"}}]))
        return _case("wrong unit or frame", files()["b.inp"], "refuse", **keys)

    pipes = [
        Case("mesh", f"a {w}", {f: w}, build(f), "refuse")
        for f in GROUPS
        for w in ("pipe", "folder")
    ]
    return cut() | line() | known() | settings() | st.sampled_from(pipes)


def _fortran(deck: str) -> str:
    """The deck with all coordinates in the format of Fortran."""
    nodes, rest = deck.split("*ELEMENT", 1)
    head, *rows = nodes.strip().split("\n")
    rows = [
        ", ".join(
            [row.split(",")[0], *(f"{float(x):.16E}".replace("E", "D") for x in row.split(",")[1:])]
        )
        for row in rows
    ]
    return "\n".join([head, *rows, "*ELEMENT" + rest])


def _flat(deck: str) -> str:
    """The deck with its blade in a plane: all Jacobians are zero."""
    nodes, rest = deck.split("*ELEMENT", 1)
    head, *rows = nodes.strip().split("\n")
    cells = [row.split(",") for row in rows]
    rows = [f"{n},{x},{float(z) / 2!r},{z}" for n, x, _, z in cells]
    return "\n".join([head, *rows, "*ELEMENT" + rest])


def _assembly(deck: str) -> str:
    """The deck as Abaqus/CAE writes it, with a reference point of the assembly."""
    mesh, sets = deck.split("*NSET, NSET=root", 1)
    sets = ("*NSET, NSET=root" + sets).replace("\n*NSET", "\n*Nset")
    sets = sets.replace("=root", "=root, instance=B-1").replace("=tip", "=tip, instance=B-1")
    head = f"*Heading\n*Part, name=B\n{mesh}*End Part\n*Assembly, name=A\n"
    head += "*Instance, name=B-1, part=B\n*End Instance\n*Node\n1, 0., 0., 0.\n"
    return f"{head}*Nset, nset=RP\n1,\n{sets}*End Assembly\n"


def _fortran_bulk(bulk: str) -> str:
    """The bulk data with one coordinate in the format of Fortran, of the same width."""
    at = bulk.index("GRID*") + 40  # fields of 8, 16, 16, 16 and 16 characters
    new = f"{float(bulk[at : at + 16]):.9E}".replace("E", "D").rjust(16)
    return bulk[:at] + new + bulk[at + 16 :]


def _grid_twice(bulk: str) -> str:
    return bulk.replace(f"GRID*   {2:16d}", f"GRID*   {1:16d}")


STEP = (
    "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n"
    "#1 = ( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) );\nENDSEC;\n"
)


def cad() -> Cases:
    """CAD files that are refused before the library reads them."""
    contents = [b"", b"x", STEP.encode(), b"ISO-10303-21;\nEND-ISO-10303-21;\n", bytes(range(256))]
    contents += ["folder", "pipe", STEP.encode("utf-16")]
    names = ("b.step", "b.stp", "b.igs", "b")

    @st.composite
    def case(draw: st.DrawFn) -> Case:
        name, content = draw(st.sampled_from(names)), draw(st.sampled_from(contents))
        faces = {"root": {"radius_mm": 422.5}, "tip": {"radius_mm": 562.3}}

        def read(folder: Path) -> Any:
            blade = changed(coarse(), cad={"file": name, "unit": "mm"} | faces)
            return build_mesh(blade, folder / "blade.msh", folder / name)

        return Case("cad", "no CAD file", {name: content}, read, "refuse")

    return case()


def built() -> Cases:
    """Parameters of the sections: what is accepted has the volume of its closed form."""
    slips = {  # factor, and whether the blade is one that somebody may mean
        "hub.thickness_mm": ((10, "refuse"), (0.7, "accept"), (1.2, "accept")),
        "tip.thickness_mm": ((30, "refuse"), (0.8, "either")),
        "span_mm": ((1.2, "accept"), (0.01, "refuse"), (100, "refuse")),
        "tip.stagger_deg": ((0.8, "accept"), (-1, "either"), (1.8, "either")),
        "tip_lean_axial_mm": ((-2, "accept"), (200, "refuse"), (1000, "refuse")),
        "tip_lean_tangential_mm": ((-3, "accept"), (3000, "refuse")),
        "edge_thickness_percent": ((1.5, "accept"), (1e-5, "refuse")),
        "hub_radius_mm": ((1.1, "accept"), (10, "refuse")),
        "element": (
            (20, "refuse"),
            (0.5e-3, "refuse"),
            (1.2, "either"),
            (3, "either"),
            (30, "refuse"),
        ),
    }

    @st.composite
    def case(draw: st.DrawFn) -> Case:
        key = draw(st.sampled_from(sorted(slips)))
        factor, must = draw(st.sampled_from(slips[key]))
        values = coarse().model_dump(exclude_unset=True)
        *parents, last = key.split(".")
        place = values["mesh"] if key == "element" else values["sections"]
        for name in parents:
            place = place[name]
        last = "element_size_mm" if key == "element" else last
        place[last] *= factor

        def read(folder: Path) -> Any:
            blade = changed(coarse(), **values)
            return build_mesh(blade, folder / "blade.msh")

        sections = values["sections"]
        fault = of_volume(lambda: closed_form(sections), CLOSE)
        return Case("blade to mesh", f"{key} x {factor:g}", {"test": b""}, read, must, fault)

    return case()


def closed_form(sections: dict[str, Any]) -> float:
    """Volume between the planes of hub and tip, m3; the cylinders' cut is below 2e-4 of it."""
    s = Blade.model_validate(
        coarse().model_dump(exclude_unset=True) | {"sections": sections}
    ).sections
    hub, middle, tip = (profile_at(s, s.hub_radius + f * s.span) for f in (0, 0.5, 1))
    return s.span * (hub.area + 4 * middle.area + tip.area) / 6


def mesh_cases() -> Cases:
    """All of these."""
    return st.one_of(decks(), decks(), formats(), cad(), built())
