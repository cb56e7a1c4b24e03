"""Meshes, CAD files and parameters that are meshed, changed as people and accidents change them."""

import shutil
import tempfile
import warnings
from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial, reduce
from itertools import product
from operator import getitem
from pathlib import Path
from typing import Any

import exports
import gmsh
import numpy as np
from blades import given as changed, volume as exact_volume
from bricks import Bricks
from case import Case, Content
from changes import LONG, binary, cell, contents, cut, line, long, other_line, size
from hypothesis import strategies as st
from yaml_cases import WORKFLOW, Cases

from geometry.base import MeshWarning
from geometry.blade import Blade
from geometry.mesh import build_mesh
from geometry.profile import profile_at
from geometry.shape import merge, session
from geometry.split import KINDS

SAME = 1e-6  # relative, of volumes of one mesh: files hold some nine digits
CLOSE = 5e-3  # of a mesh against the closed form of its blade, as coarse as it is


@cache
def coarse() -> Blade:
    """The reference blade on 768 cells."""
    blade = Blade.load(WORKFLOW / "blades/reference.yaml")
    return blade.but(mesh__element_size_mm=10.0, interface__patches=8)


@cache
def files() -> dict[str, str]:
    """Its mesh in the formats of other programs."""
    with tempfile.TemporaryDirectory() as folder:
        mesh = Path(folder) / "blade.msh"
        build_mesh(coarse(), mesh)
        parts = exports.parts(mesh)
        for name, (write, *_) in FORMATS.items():
            write(mesh.with_name(name), *parts)
        bricks = Bricks(coarse().sections, 4, 1, 8).parts("hexahedron")
        exports.write_inp(mesh.with_name(BRICKS), *bricks, kind="C3D20")
        with session("-"):
            merge(shutil.copy(mesh, mesh.with_name(OURS)))
            gmsh.option.setNumber("Mesh.Binary", 1)
            gmsh.write(str(mesh.with_name(BINARY)))
        texts = {name: mesh.with_name(name).read_bytes() for name in (*DECKS, *OTHERS)}
        return {name: text.decode(errors="surrogateescape") for name, text in texts.items()}


FORMATS = {f"b{suffix}": of for suffix, of in exports.FORMATS.items()}
OURS, BINARY = "ours.msh", "binary.msh"  # MSH 4.1, in m
OTHERS = [*FORMATS, OURS, BINARY][1:]  # which numpy_volume does not read
SIZES = {  # where a format says how many there are, or numbers them
    "b.inp": [r"^(\d+), ", r"^\*NSET, NSET=root\n(\d+),"],
    "b.bdf": [r"^GRID\*   ( *\d+)", r"^CTETRA  ( *\d+)( *1)"],
    "b.cdb": [
        r"^NBLOCK,6,SOLID,( *\d+),( *\d+)\n\((\d)i(\d),(\d)e(\d+)\.(\d+)",
        r"^EBLOCK,19,SOLID,( *\d+),( *\d+)\n\((\d+)i(\d)",
        r"^CMBLOCK,\w+ *,NODE,( *\d+).*\n\((\d)i(\d+)\)\n( *\d+)( *\d+)",
        r"^( *\d+)( +0) +0 ",
    ],
    "b.vtu": [r'NumberOf(?:Points|Cells)="(\d+)"', r'NumberOfComponents="(\d+)"'],
    "b.msh": [r"^\$(?:Nodes|Elements|PhysicalNames)\n(\d+)\n(\d+) (\d+)"],
    OURS: [
        r"^\$(?:Nodes|Elements)\n(\d+) (\d+) (\d+) (\d+)\n(\d+) (\d+) (\d+) (\d+)\n(\d+)",
        r"^\$(?:PhysicalNames|Entities)\n(\d+)",
    ],
}
MORE = {  # lines that stand for many, at the end
    "b.inp": (
        "*NSET, NSET=x, GENERATE\n1, 1000000000000, 1",
        "*ELSET, ELSET=x, GENERATE\n1, 99999999999",
    ),
    "b.cdb": (
        "CMBLOCK,X,NODE,2\n(8i14)\n             1-1000000000000",
        "CMBLOCK,X,ELEM,2\n(8i10)\n         1-999999999",
    ),
    "b.msh": ("$Nodes\n" * 50_000, "$Elements\n1000000000000"),
    OURS: ("$Nodes\n" * 50_000, "$Nodes\n1 1000000000000 1 1000000000000"),
    "b.bdf": ("CTETRA  " + "        +\n+" * 50_000,),
    "b.vtu": ("<a>" * 100_000, '<!DOCTYPE a [<!ENTITY b "b">]>'),
}
BRICKS = "bricks.inp"
DECKS = ("b.inp", BRICKS)


@cache
def volume() -> float:
    """Volume of the unchanged mesh, m3."""
    return numpy_volume(files()["b.inp"])


def numpy_volume(deck: str) -> float:
    """Volume, m3, of the cells of a deck in our own format, read line by line.

    Of ten or twenty nodes. The determinant of a cell is a polynomial: the rules are exact.
    """
    nodes, cells, of = {}, {}, None
    for row in deck.splitlines():
        if row.startswith("*"):
            of = nodes if row.upper().startswith("*NODE") else None
            of = cells if row.upper().startswith("*ELEMENT") else of
        elif of is not None and row.strip():
            number, *values = row.upper().replace("D", "E").split(",")
            of.setdefault(int(number), [float(value) for value in values])
    points = 1e-3 * np.array([[nodes[int(i)] for i in cell] for cell in cells.values()])
    if points.shape[1] == 20:
        return volume_of_bricks(points)
    return exact_volume(points.reshape(-1, 3), np.arange(points[..., 0].size).reshape(-1, 10))


def volume_of_bricks(points: np.ndarray) -> float:
    """Volume of bricks (m, 20, 3), by their own map."""
    at, weights = np.polynomial.legendre.leggauss(4)
    corners = np.array(list(product((-1, 1), repeat=3)))[[0, 4, 6, 2, 1, 5, 7, 3]]
    own = np.vstack([corners, corners[KINDS["hexahedron"].edges].mean(axis=1)])

    def shapes(x: np.ndarray) -> np.ndarray:
        along = 1 + own * x  # (20, 3)
        of_corners = along.prod(axis=1) * ((own * x).sum(axis=1) - 2) / 8
        of_middles = np.where(own == 0, 1 - x**2, along).prod(axis=1) / 4
        return np.where((own == 0).any(axis=1), of_middles, of_corners)

    total, small = 0.0, 1e-5
    for place, weight in zip(product(at, repeat=3), product(weights, repeat=3), strict=True):
        x = np.array(place)
        gradient = [
            (shapes(x + small * axis) - shapes(x - small * axis)) / (2 * small)
            for axis in np.eye(3)
        ]
        total += np.prod(weight) * np.linalg.det(np.array(gradient) @ points).sum()
    return float(total)


def build(file: str, root: Any = None, **keys: Any) -> Callable[[Path], Any]:
    """Mesh of a blade from a file in a folder."""

    def read(folder: Path) -> Any:
        same = {BRICKS: "b.inp", OURS: "b.msh", BINARY: "b.msh"}
        groups = (root, 562.3) if root else FORMATS[same.get(file, file)][1:]
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


def _case(
    change: str,
    text: str,
    must: str = "either",
    file: str = "b.inp",
    data: Content | None = None,
    **keys: Any,
) -> Case:
    """A mesh whose file has ``text``, or ``data`` that say the same."""
    data = text.encode(errors="surrogateescape") if data is None else data
    expected = (lambda: numpy_volume(text)) if file in DECKS else volume
    if file == BRICKS:
        keys["interface"] = {"patches": 4}
    if file in (OURS, BINARY):
        keys["unit"] = "m"
    close = CLOSE if file == BRICKS else SAME
    fault = of_volume(expected, close)
    return Case("mesh", change, {file: data}, build(file, **keys), must, fault)


def rows(text: str, of: str) -> list[int]:
    """Lines of a deck below a card."""
    lines = text.split("\n")
    cards = [i for i, line in enumerate(lines) if line.startswith("*")] + [len(lines) - 1]
    first = next(i for i in cards if lines[i].startswith(of))
    return list(range(first + 1, cards[cards.index(first) + 1]))


def decks(file: str) -> Cases:
    """A deck: lines, numbers and nodes lost, changed or there twice."""
    text = files()[file]
    nodes, elements = rows(text, "*NODE"), rows(text, "*ELEMENT")
    cards = [i for i, line in enumerate(text.split("\n")) if line.startswith("*")]
    odd = ["", "x", "1_0", "nan", "1.0D+01", "-1", "0", "999999", "1", "٣", "1e400", "1" * 5000]
    names = ["", "*", "*NODE", "*ELEMENT", "*NSET", "*ELEMENT, TYPE=C3D4", "*ELSET, ELSET=x"]
    changed = [other_line(text, cards, names), long(text, nodes)]
    for of in (nodes, elements):
        changed += [cell(text, of, odd, st.nothing()), line(text, of, "lost", "twice", "cut")]

    def case(change: tuple[str, str]) -> Case:
        return _case(*change, "accept" if change[0] == "line twice" else "either", file)

    @st.composite
    def moved(draw: st.DrawFn) -> Case:
        lines, i = text.split("\n"), draw(st.sampled_from(nodes))
        number, *place = lines[i].split(",")
        far = draw(st.sampled_from((0.01, 0.5, 5.0, 50.0, 1e4)))
        axis, sign = draw(st.integers(0, 2)), draw(st.sampled_from((-1, 1)))
        place[axis] = f"{float(place[axis]) + sign * far!r}"
        lines[i] = ",".join([number, *place])
        return _case("node moved", "\n".join(lines), "refuse" if far >= 50 else "either", file)

    def short(n: int) -> Case:
        """Without its end; where all numbers are there it is whole."""
        whole = n >= len(text.rstrip(",\n"))
        return _case("cut short", text[:n], "accept" if whole else "refuse", file)

    def shorter(n: int) -> Case:
        """Within the elements: the sets are lost, and the root is by its radius."""
        return _case("cut short", text[:n], file=file, root=422.5)

    within = st.integers(text.index("*ELEMENT"), text.index("*NSET, NSET=root") - 1)
    cuts = st.integers(0, len(text) - 2).map(short) | within.map(shorter)

    @st.composite
    def unmerged(draw: st.DrawFn) -> Case:
        lines, i = text.split("\n"), draw(st.sampled_from(elements))
        cells = lines[i].split(", ")
        others = {node for j in elements if j != i for node in lines[j].split(", ")[1:]}
        at = draw(st.sampled_from([k for k in range(1, len(cells)) if cells[k] in others]))
        place = lines[nodes[int(cells[at]) - 1]].split(",")[1:]
        cells[at] = "99999"
        lines[i] = ", ".join(cells)
        lines.insert(nodes[-1] + 1, ",".join(["99999", *place]))
        return _case("node not merged", "\n".join(lines), "refuse", file)

    return st.one_of(*changed).map(case) | moved() | cuts | unmerged()


def sizes() -> Cases:
    """Numbers of nodes and cells, ranges and texts that are much longer than what the file has."""

    def of(file: str) -> Cases:
        text = files()[file]
        n = text.count("\n")
        changed = size(text, *SIZES[file]) | long(text, [*range(min(n, 40)), n // 2, n - 2])
        more = st.sampled_from(MORE[file]).map(lambda lines: ("more lines", f"{text}{lines}\n"))
        return (changed | more).map(lambda change: _case(*change, file=file))

    @st.composite
    def of_bytes(draw: st.DrawFn) -> Case:
        data = files()[BINARY].encode(errors="surrogateescape")
        change, data = draw(binary(data))
        case = _case(change, files()[BINARY], file=BINARY, data=data)
        return replace(case, fault=lambda summary: "")  # a bit of a number is seen by nobody

    return st.sampled_from(sorted(SIZES)).flatmap(of) | of_bytes()


def formats() -> Cases:
    """All formats: other encodings, numbers of Fortran, files cut short, wrong units and frames."""
    deck, bulk = files()["b.inp"], files()["b.bdf"]
    known = [
        _case(change, files()[file], must, file, data)
        for file in FORMATS
        for change, (data, must) in contents(deck if file == "b.inp" else "").items()
        if file == "b.inp" or must == "refuse"
    ]
    known += [
        _case("Latin-1", deck, "accept", data=b"** \xfc\n" + deck.encode()),
        _case("small letters", deck.lower(), "accept"),
        _case("Fortran", exports.fortran(deck), "accept"),
        _case("no ENDDATA", bulk.replace("ENDDATA", ""), "refuse", "b.bdf"),
        _case("syntax of Abaqus", deck, "accept", "b.msh"),
        _case("another format", files()["b.msh"], "refuse"),
        _case("unchanged", deck, "accept"),
    ]
    changed = [
        strategy.map(partial(_other, file))
        for file in OTHERS
        for strategy in (
            cut(files()[file][: int(0.98 * len(files()[file]))]),
            line(files()[file], range(files()[file].count("\n")), "lost", "twice"),
        )
    ]

    axes = ("x", "-x", "y", "-y", "z", "-z")
    frames = [
        {"downstream": down, "radial": radial}
        for down, radial in product(axes, axes)
        if down[-1] != radial[-1] and (down, radial) != ("z", "x")
    ]
    wrong = [{"frame": frame} for frame in (*frames, {"rotation": "left-handed"})]
    wrong += [{"unit": unit} for unit in ("m", "cm", "in")]
    settings = [_case("wrong unit or frame", deck, "refuse", **keys) for keys in wrong]
    return st.one_of(*changed, st.sampled_from(known), st.sampled_from(settings))


def _other(file: str, change: tuple[str, str]) -> Case:
    """Of a format that says where it ends."""
    return _case(*change, "refuse" if change[0] == "cut short" else "either", file)


STEP = (
    "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n"
    "#1 = ( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) );\nENDSEC;\n"
)
STEPS = [("UNIT(", f"UNIT{LONG[name]}(") for name in ("only  ", "only \n", "only '", "only 1")]
STEPS += [
    ("#1", f"#{'9' * 5000}"),
    ("(", "(" * 10_000),
    (" = (", "= CLOSED_SHELL('',(#1));\n#2 = ("),
]


def cad() -> Cases:
    """CAD files that are refused before the library reads them."""
    data = [b"", b"x", STEP.encode(), b"ISO-10303-21;\nEND-ISO-10303-21;\n", bytes(range(256))]
    data += ["folder", "pipe", STEP.encode("utf-16")]
    data += [f"{STEP}{text}END-ISO-10303-21;\n".encode() for text in LONG.values()]
    data += [STEP.replace(*change).encode() + b"END-ISO-10303-21;" for change in STEPS]
    names = ("b.step", "b.stp", "b.igs", "b", "b.brep")

    faces = {"root": {"radius_mm": 422.5}, "tip": {"radius_mm": 562.3}}

    def case(name: str, content: Content) -> Case:
        def read(folder: Path) -> Any:
            blade = changed(coarse(), cad={"file": name, "unit": "mm"} | faces)
            return build_mesh(blade, folder / "blade.msh", folder / name)

        return Case("cad", "no CAD file", {name: content}, read, "refuse")

    return st.builds(case, st.sampled_from(names), st.sampled_from(data))


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
    }
    sizes = ((20, "refuse"), (0.5e-3, "refuse"), (1.2, "either"), (3, "either"), (30, "refuse"))
    slips = {f"sections.{key}": of for key, of in slips.items()} | {"mesh.element_size_mm": sizes}

    @st.composite
    def case(draw: st.DrawFn) -> Case:
        key = draw(st.sampled_from(sorted(slips)))
        factor, must = draw(st.sampled_from(slips[key]))
        values = coarse().model_dump(exclude_unset=True)
        *parents, last = key.split(".")
        reduce(getitem, parents, values)[last] *= factor

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
    of_decks = decks("b.inp"), decks("b.inp"), decks(BRICKS)
    kinds = [*of_decks, formats(), sizes(), sizes(), sizes(), cad(), built()]
    return st.integers(0, len(kinds) - 1).flatmap(kinds.__getitem__)  # each as often
