"""Contact at every node of the tip, on a coarse mesh, as a reference for patches and strips.

Each node is in contact with rods of its own, for its share of the tip's area. Nodes at one station
of the chord pass over the same liner: after every round its wear is the deepest of all of them.
This model includes tilt and torsion across the thickness, which the patches average out. A second
model, in which each node moves with the patches, has the same places and areas but no tilt: it
separates the two causes of a difference.
"""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix, identity

from fem.interface import at_places, quadrature
from fem.matrices import Matrices
from fem.solid import Solid, read_solid
from geometry.blade import Blade
from geometry.hats import hats, middles
from geometry.interface import tip_of
from geometry.tip import on_line
from rom.model import Rom
from rom.reduce import reduce
from simulate.contact.places import Places
from simulate.errors.observables import Observables, error, observables
from simulate.errors.run import Case as Prepared, Run
from simulate.marching import Setup, march, prepare
from simulate.marching.piecewise_exact import gain
from simulate.marching.setup import strips_under
from simulate.scene import LEADING, Record, Scene
from workflow.study.trade import Row, amplitude

STATIONS = 24  # intervals of the chord; nodes of the tip are 2.5 mm apart


@dataclass(frozen=True)
class Nodes:
    """The nodes of the tip as the interface."""

    S: csr_matrix  # (3 nodes, n_full), their radial, tangential and axial displacements
    places: Places  # of the width of each node's share of the area at its station, times ``across``
    across: float  # mean number of nodes across the thickness
    station: NDArray[np.int64]  # (nodes,), the nearest, from 0


class Moves(NamedTuple):
    """A reduced model, and how its coordinates move the nodes and xi = 1/16."""

    rom: Rom
    at_nodes: NDArray[np.float64]  # (nodes, n)
    at_leading: NDArray[np.float64]  # (1, n)


def numbers(files: Any, blade: str, scenes: dict[str, Row]) -> list[Row]:
    """The default interface against all nodes, moving freely and then with the patches.

    For the blade in the file ``blade``, from ``files.matrices`` and ``files.mesh``.
    """
    settings, fom = Blade.load(blade), Matrices.load(files.matrices)
    nodes, leading = _nodes(settings, fom.camber, files.mesh), np.array([LEADING])
    xi = nodes.places.xi
    rom, _ = reduce(fom, settings.basis, "r")
    of_nodes, T = reduce(replace(fom, S=nodes.S, xi=xi), settings.basis, "r")
    at_leading = hats(leading, rom.xi) @ (fom.rows("r") @ T)
    moving = {
        "on their own": Moves(of_nodes, np.eye(len(xi), of_nodes.n), at_leading),
        "as the patches": Moves(rom, rom.rows(xi), rom.rows(leading)),
    }
    rows = []
    for name, values in scenes.items():
        case = Scene(**values).but(blade=rom.provenance.blade)
        (Omega,) = case.speeds.omega(rom.f1)
        default = observables(Prepared(case, rom, prepare(case, rom, Omega)).march())
        for how, moves in moving.items():
            full = _march(case, rom, Omega, moves, nodes)
            of = {"scene": name, "nodes": len(xi), "moving": how}
            rows.append(of | _changes(default, full))
    return rows


def _nodes(blade: Blade, camber: NDArray[np.float64], mesh: str | Path) -> Nodes:
    solid = read_solid(str(mesh), blade.material)
    points, used = solid.V.tabulate_dof_coordinates(), np.unique(solid.tip)
    xi = np.clip(tip_of(solid.tip, points).xi(points[used]), 0, 1)
    x, y, _ = points[used].T
    S = at_places(identity(len(points), format="csr")[used], points[used], solid.free)
    station = np.round(xi * STATIONS).astype(int)
    area, across = node_areas(solid)[used], len(used) / (STATIONS + 1)
    there = np.bincount(station, area, STATIONS + 1)
    width = np.diff(on_line(camber, _ends())[:, 2])[station] * (area / there[station]) * across
    radius, theta = np.hypot(x, y), np.arctan2(y, x)
    return Nodes(S, Places(np.array([0.0, 1.0]), xi, radius, theta, width, 0 * xi), across, station)


def _ends() -> NDArray[np.float64]:
    """Chord fractions halfway between the stations, and both ends (STATIONS + 2,)."""
    return np.concatenate([[0], middles(STATIONS), [1]])


def _march(case: Scene, rom: Rom, Omega: float, moves: Moves, nodes: Nodes) -> Observables:
    """March round by round; after each, the liner of a station is worn as by its deepest node.

    The footprint is divided by the mean number of nodes across the thickness and the widths are
    multiplied by it: the areas are kept.
    """
    footprint = case.liner.footprint_m / nodes.across
    samples = case.record.samples_per_round
    record = Record(samples_per_round=samples, history={"chord": [LEADING]}, end=True)
    narrow = case.but(rounds=1, record=record, liner__footprint_m=footprint)
    setup = _setup(narrow, rom, Omega, moves, nodes.places)
    left, u_r = None, []
    for _ in range(case.rounds):
        done = march(narrow, setup, left)
        u_r.append(done.u_r)
        worn = np.zeros((STATIONS + 1, case.liner.rods_per_round))
        np.maximum.at(worn, nodes.station, done.final.eps_p)
        left = replace(done.final, eps_p=worn[nodes.station])
    wear = case.liner.thickness_m * worn
    whole = replace(done, u_r=np.concatenate(u_r), wear=wear, ends=_ends())
    return observables(Run(case, rom, setup, outcome=whole))


def _setup(scene: Scene, rom: Rom, Omega: float, moves: Moves, places: Places) -> Setup:
    """The set-up of the scene with contact at other places than the strips."""
    setup = prepare(scene, rom, Omega)
    omega, Phi = moves.rom.modes(Omega)
    Phi_b = moves.at_nodes @ Phi
    compliance = Phi_b**2 @ gain(omega, scene.damping_ratio, setup.h)
    return replace(
        setup,
        omega=omega,
        Phi=Phi,
        Phi_b=Phi_b,
        Phi_out=moves.at_leading @ Phi,
        Phi_timing=Phi[:0],
        places=places,
        strips=strips_under(scene, rom, places, setup.Omega, setup.steps, compliance),
        bound=np.inf,
    )


def _changes(own: Observables, full: Observables) -> Row:
    """Relative differences of the default interface from all nodes; of wear the error in L2."""
    return {
        "amplitude": amplitude(own) / amplitude(full) - 1,
        "wear": error(own["wear"], full["wear"]),
        "volume": float(own["wear"].mean() / full["wear"].mean()) - 1,
    }


def node_areas(solid: Solid) -> NDArray[np.float64]:
    """Area (nodes,), m2, of the tip that belongs to each node of the mesh.

    In proportion to the diagonal of the facets' mass matrices (Hinton, Rock and Zienkiewicz 1976),
    since the integrals of the corners' shape functions are zero.
    """
    points, facets = solid.V.tabulate_dof_coordinates(), solid.tip
    _, dA, values = quadrature(points[facets])
    diagonal = dA @ values**2
    shares = dA.sum(axis=1, keepdims=True) * diagonal / diagonal.sum(axis=1, keepdims=True)
    return np.bincount(facets.ravel(), shares.ravel(), len(points))
