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
from scipy.sparse import csr_matrix

from fem.interface import node_areas
from fem.matrices import Matrices
from fem.solid import read_solid
from geometry.blade import Blade
from geometry.hats import hats, middles
from geometry.interface import tip_of
from geometry.project import read_settings
from rom.model import Rom
from rom.reduce import reduce
from simulate.contact.compiled import for_types_of
from simulate.contact.places import Places, by_share
from simulate.contact.ramp import ramp_of
from simulate.errors.observables import error
from simulate.errors.signals import on_rods
from simulate.marching import piecewise_exact
from simulate.marching.kernel import Recorded, at_start, march_round
from simulate.marching.modal import padded_rows
from simulate.marching.run import march
from simulate.marching.setup import prepare, strips_under
from simulate.scene import LEADING, Scene
from workflow.study.interface_plan import SCENES
from workflow.study.trade_runs import SAMPLES, Row, last_amplitude, recording

STATIONS = 24  # intervals of the chord; nodes of the tip are 2.5 mm apart
STEPS, RODS = 2**13, 4093  # per round


@dataclass(frozen=True)
class Nodes:
    """The nodes of the tip as the interface."""

    S: csr_matrix  # (3 nodes, n_full), their radial displacements; the other rows are 0
    xi: NDArray[np.float64]  # (nodes,), chord fractions
    theta: NDArray[np.float64]  # (nodes,), rad
    radius: NDArray[np.float64]  # (nodes,), m
    area: NDArray[np.float64]  # (nodes,), share of the tip's area at the node's station
    station: NDArray[np.int64]  # (nodes,), the nearest, from 0


class Moves(NamedTuple):
    """Modes of a blade at a speed, with their displacements at the nodes and at xi = 1/16."""

    omega: NDArray[np.float64]  # (n,), rad/s
    at_nodes: NDArray[np.float64]  # (nodes, n)
    at_leading: NDArray[np.float64]  # (1, n)


def numbers(files: Any, blade: str, scenes: dict[str, Row]) -> list[Row]:
    """The default interface against all nodes, moving freely and then with the patches.

    For the blade in the file ``blade``, from ``files.matrices`` and ``files.mesh``.
    """
    settings, fom = read_settings(Blade, blade), Matrices.load(files.matrices)
    nodes = _nodes(settings, files.mesh)
    rom, _ = reduce(fom, settings.basis, "r")
    of_nodes, T = reduce(replace(fom, S=nodes.S, xi=nodes.xi), settings.basis, "r")
    leading = np.array([LEADING])
    at_leading = hats(leading, rom.xi) @ (fom.rows(1) @ T)
    rows = []
    for name, values in scenes.items():
        case = recording(
            Scene(**values), rom, RODS, scheme="piecewise-exact", steps_per_round=STEPS
        )
        Omega = rom.omega1 * SCENES[name].speed
        outcome = march(case, prepare(case, rom, Omega))
        default = outcome.u_r[:, 0], by_share(outcome.wear, outcome.ends)
        omega, Phi = of_nodes.modes(Omega)
        alone = Moves(omega, Phi[: len(nodes.xi)], at_leading @ Phi)
        omega, Phi = rom.modes(Omega)
        patches = Moves(omega, rom.rows(nodes.xi) @ Phi, rom.rows(leading) @ Phi)
        for moving, moves in (("on their own", alone), ("as the patches", patches)):
            full = _march(case, rom, Omega, moves, nodes)
            of = {"scene": name, "nodes": len(nodes.xi), "moving": moving}
            rows.append(of | _changes(default, full))
    return rows


def _nodes(blade: Blade, mesh: str | Path) -> Nodes:
    solid = read_solid(str(mesh), blade.material)
    points, used = solid.V.tabulate_dof_coordinates(), np.unique(solid.tip)
    xi = np.clip(tip_of(solid.tip, points).xi(points[used]), 0, 1)
    x, y, _ = points[used].T
    theta, row = np.arctan2(y, x), np.repeat(3 * np.arange(len(used)), 2)  # radial: the first of 3
    column = (3 * used[:, None] + np.arange(2)).ravel()
    values = np.column_stack([np.cos(theta), np.sin(theta)]).ravel()
    S = csr_matrix((values, (row, column)), shape=(3 * len(used), 3 * len(points)))[:, solid.free]
    station = np.round(xi * STATIONS).astype(int)
    area = node_areas(solid)[used]
    there = np.bincount(station, area, STATIONS + 1)
    return Nodes(S, xi, theta, np.hypot(x, y), area / there[station], station)


def _ends() -> NDArray[np.float64]:
    """Chord fractions halfway between the stations, and both ends (STATIONS + 2,)."""
    return np.concatenate([[0], middles(STATIONS), [1]])


def _march(
    scene: Scene, rom: Rom, Omega: float, moves: Moves, nodes: Nodes
) -> tuple[NDArray, NDArray]:
    """u_r (time,) at xi = 1/16, m, and the wear at the stations (STATIONS + 1, nu), m.

    The footprint is divided by the mean number of nodes across the thickness and the widths are
    multiplied by it: the areas are kept.
    """
    across = len(nodes.xi) / (STATIONS + 1)
    case = scene.but(liner__footprint_m=scene.liner.footprint_m / across)
    width = np.diff(rom.line(_ends())[:, 2])[nodes.station] * nodes.area * across
    places = Places(np.array([0.0, 1.0]), nodes.xi, nodes.radius, nodes.theta, width)
    h, zeta = 2 * np.pi / Omega / STEPS, case.damping_ratio
    compliance = moves.at_nodes**2 @ piecewise_exact.gain(moves.omega, zeta, h)
    strips = strips_under(case, rom, places, STEPS, compliance)
    scheme = piecewise_exact.coefficients(moves.omega, moves.at_nodes, zeta, h)
    state = at_start(scheme, strips)
    samples = np.zeros((SAMPLES, 1))
    recorded = Recorded(
        samples,
        np.zeros((3, 0)),
        np.zeros((0, state.motion.x.shape[1])),
        padded_rows(moves.at_leading),
        np.zeros((0, len(nodes.xi))),
    )
    u, arguments = [], (scheme, strips, state, recorded, ramp_of(case.casing), np.inf)
    march_on = for_types_of(march_round, *arguments, 0, STEPS)
    for done in range(case.rounds):
        march_on(*arguments, done, STEPS)
        u.append(samples[:, 0].copy())
        worn = np.zeros((STATIONS + 1, strips.d.size))
        np.maximum.at(worn, nodes.station, state.eps_p)
        state.eps_p[:] = worn[nodes.station]
    return np.concatenate(u), strips.thickness * worn


def _changes(own: tuple[NDArray, NDArray], full: tuple[NDArray, NDArray]) -> Row:
    """Relative differences of the default interface from all nodes; of wear the error in L2."""
    wear = [on_rods(own[1], RODS), by_share(full[1], _ends())]
    return {
        "amplitude": last_amplitude(own[0], SAMPLES) / last_amplitude(full[0], SAMPLES) - 1,
        "wear": error(*wear),
        "volume": float(wear[0].mean() / wear[1].mean()) - 1,
    }
