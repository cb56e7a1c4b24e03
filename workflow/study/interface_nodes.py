"""Contact at every node of the tip, on a coarse mesh: the patches and strips held against it.

Each node bears on rods of its own, of its share of the tip's area. Nodes at one station of the
chord pass over the same liner: after every round all of them find it worn as the deepest has left
it. What the hats average out across the thickness, lean and torsion, is in this model. The cause of
what differs is told by the same contact where each node moves as the patches do: it has the nodes'
places and areas, and no lean.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.sparse import csr_matrix

from fem.interface import node_areas
from fem.matrices import Matrices
from fem.solid import read_solid
from geometry.blade import Blade
from geometry.hats import hats, middles
from geometry.interface import tip_of
from geometry.settings import read_settings
from rom.basis import enriched_basis
from rom.components import natural_components
from rom.model import Rom
from rom.polynomial import evaluate, interpolate
from rom.projection import project
from rom.reduce import reduce
from simulate import piecewise_exact
from simulate.compare import error
from simulate.march import Recorded, at_start, march_kernel
from simulate.modal import padded_rows
from simulate.observables import on_rods
from simulate.places import SHARES, Places, by_share
from simulate.run import features, march, prepare, strips_under
from simulate.scene import LEADING, Scene
from workflow.study.interface_plan import SCENES
from workflow.study.trade_errors import last_amplitude
from workflow.study.trade_runs import SAMPLES, recording

STATIONS = 24  # of the chord between its ends, as nodes of the tip stand: 2.5 mm apart
STEPS, RODS = 2**13, 4093  # per round

type Row = dict[str, Any]


@dataclass(frozen=True)
class Nodes:
    """The nodes of the tip, as interface."""

    S: csr_matrix  # (nodes, n_full), their radial displacements
    xi: NDArray[np.float64]  # (nodes,), chord fractions
    theta: NDArray[np.float64]  # (nodes,), rad
    radius: NDArray[np.float64]  # (nodes,), m
    area: NDArray[np.float64]  # (nodes,), share of the tip's area at the node's station
    station: NDArray[np.int64]  # (nodes,), the nearest, from 0


class Moves(NamedTuple):
    """Modes of a blade at a speed, and how they move the nodes and the place of the outputs."""

    omega: NDArray[np.float64]  # (n,), rad/s
    at_nodes: NDArray[np.float64]  # (nodes, n)
    at_leading: NDArray[np.float64]  # (1, n)


def numbers(files: Any, blade: str, scenes: dict[str, Row]) -> list[Row]:
    """``against_nodes`` of a blade, ``blade`` its file, from ``files.matrices``, ``files.mesh``."""
    made = {name: Scene(**values) for name, values in scenes.items()}
    fom = Matrices.load(files.matrices)
    return against_nodes(made, read_settings(Blade, blade), fom, files.mesh)


def against_nodes(
    scenes: dict[str, Scene], blade: Blade, fom: Matrices, mesh: str | Path
) -> list[Row]:
    """The default interface against all nodes, each moving on its own, then as the patches."""
    nodes = _nodes(blade, mesh)
    rom, _ = reduce(fom, blade.basis, "r")
    modes = blade.basis.natural_modes
    at_speeds = [natural_components(K, fom.M, nodes.S, modes) for K in fom.K]
    T = enriched_basis(at_speeds, nodes.S, fom.K[0], fom.M, blade.basis.rank_tolerance)
    M = project(fom.M, T)
    K = interpolate(np.stack([project(K, T) for K in fom.K]), fom.speeds)
    at_leading = hats([LEADING], rom.xi) @ (fom.rows(1) @ T)
    rows = []
    for name, scene in scenes.items():
        case = recording(scene, rom, RODS, scheme="piecewise-exact", steps_per_round=STEPS)
        Omega = 2 * np.pi * rom.f1 * SCENES[name].speed
        setup = prepare(case, rom, Omega)
        outcome = march(case, setup)
        own = outcome.u_r[:, 0], by_share(outcome.wear, outcome.ends)
        values, Phi = eigh(evaluate(K, Omega), M)
        alone = Moves(np.sqrt(values), Phi[: len(nodes.xi)], at_leading @ Phi)
        omega, Phi = rom.modes(Omega)
        patches = Moves(omega, rom.rows(nodes.xi) @ Phi, rom.rows(np.array([LEADING])) @ Phi)
        for moving, moves in (("on their own", alone), ("as the patches", patches)):
            full = _march(case, rom, Omega, moves, nodes)
            rows.append(
                {"scene": name, "nodes": len(nodes.xi), "moving": moving} | _changes(own, full)
            )
    return rows


def _nodes(blade: Blade, mesh: str | Path) -> Nodes:
    solid = read_solid(str(mesh), blade.material)
    points, used = solid.V.tabulate_dof_coordinates(), np.unique(solid.tip)
    xi = np.clip(tip_of(solid.tip, points).xi(points[used]), 0, 1)
    x, y, _ = points[used].T
    theta, row = np.arctan2(y, x), np.repeat(np.arange(len(used)), 2)
    column = (3 * used[:, None] + np.arange(2)).ravel()
    values = np.column_stack([np.cos(theta), np.sin(theta)]).ravel()
    S = csr_matrix((values, (row, column)), shape=(len(used), 3 * len(points)))[:, solid.free]
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

    The footprint is shared out among the nodes across the thickness, each as much stiffer.
    """
    across = len(nodes.xi) / (STATIONS + 1)
    case = scene.changed(liner__footprint_m=scene.liner.footprint_m / across)
    width = np.diff(rom.line(_ends())[:, 2])[nodes.station] * nodes.area * across
    places = Places(np.array([0.0, 1.0]), nodes.xi, nodes.radius, nodes.theta, width)
    strips, h = strips_under(case, rom, places, STEPS), 2 * np.pi / Omega / STEPS
    scheme = piecewise_exact.coefficients(moves.omega, moves.at_nodes, case.damping_ratio, h)
    state = at_start(scheme, strips)
    samples = np.zeros((SAMPLES, 1))
    recorded = Recorded(
        samples,
        np.zeros((3, SHARES)),
        np.zeros((0, state.motion.x.shape[1])),
        padded_rows(moves.at_leading),
        np.zeros((SHARES, len(nodes.xi))),
    )
    kernel, u = march_kernel(features(case)), []
    for done in range(case.rounds):
        kernel(scheme, strips, state, recorded, case.casing.ramp_rounds, np.inf, done, STEPS)
        u.append(samples[:, 0].copy())
        worn = np.zeros((STATIONS + 1, strips.d.size))
        np.maximum.at(worn, nodes.station, state.eps_p)
        state.eps_p[:] = worn[nodes.station]
    return np.concatenate(u), strips.thickness * worn


def _changes(own: tuple[NDArray, NDArray], full: tuple[NDArray, NDArray]) -> Row:
    """What the default interface has more (> 0) or less than all nodes; of wear its L2 error."""
    wear = [on_rods(own[1], RODS), by_share(full[1], _ends())]
    return {
        "amplitude": last_amplitude(own[0], SAMPLES) / last_amplitude(full[0], SAMPLES) - 1,
        "wear": error(*wear),
        "volume": float(wear[0].mean() / wear[1].mean()) - 1,
    }
