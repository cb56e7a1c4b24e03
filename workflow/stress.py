"""Stress of a rub at the nodes of the blade, from a few shapes of its motion, and its margin.

Of each run the revolutions are taken that its sweep keeps, each by itself: the last one, and those
that strain the blade most. Told is the worst, at the worst node of the airfoil (``fem.fields``).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import ceil
from typing import Any

from fem.petsc import MPI  # noqa: F401  ahead of DOLFINx

import numpy as np
from numpy.linalg import norm
from numpy.typing import NDArray

from fem.fatigue import ENDURED, FIVE, LEAST, largest_change, numbers, reserve
from fem.fields import (
    airfoil,
    around,
    away,
    disagreement,
    dofs_at,
    grid_of,
    save_vtu,
    thickness,
)
from fem.solid import Solid, read_solid
from fem.worst_node import NodeStress, cycles, worst
from geometry.base import RPM, ProvenanceError
from geometry.blade import Blade
from geometry.frame import to_file
from rom.model import Rom
from rom.polynomial import evaluate
from rom.reconstruct import Basis
from simulate.marching import WITH_RESULT
from simulate.sweeps.dataset import Sweep, origin
from simulate.sweeps.peak_results import asked, with_rotation
from workflow.shapes import Shapes, motion, stresses

SHAPES = 12  # of the motion at all speeds
LABELS = {
    "mean_stress": "mean stress (Pa)",
    "alternating": "alternating stress (Pa)",
    "margin": "margin",
}
CLAMP, CONTACT = "the clamp", "the contact"  # ends of the airfoil
NONE = np.finfo(float).tiny  # of a number that is zero
AGREE = 0.05  # largest error of the mesh of a stress that is told nearer to a sharp clamp

type Revolutions = Mapping[int, NDArray[np.float64]]  # by number, from 1


def write(
    blade: Blade, mesh: str, rom: Rom, basis: str, sweep: Sweep, names: dict[str, str], vtu: str
) -> dict[str, Any]:
    """Write the fields at the told speeds; return the worst node at every speed.

    ``missed`` is the share of the motion that the shapes leave out, in the norm of the strain
    energy. Told are the speeds of the peaks and the worst of all: there it is known what the
    numbers are worth.
    """
    kept, full_basis = revolutions(sweep), Basis.load(basis, origin(sweep))
    states = [np.concatenate([*of.values()]) if of else np.empty((0, rom.n)) for of in kept]
    shapes = motion(states, rom.stiffness(rom.Omega_m / 2), SHAPES)
    solid = read_solid(mesh, blade.material)
    sigma = stresses(solid, full_basis, shapes.shapes, blade.prestress)
    stressed = Stressed(blade, solid, full_basis, shapes, sigma)
    columns = (
        sweep[name].values.tolist() for name in ("speed_over_f1", "speed", "trend", "rounds")
    )
    rows, found = [], {}
    for speed, (over_f1, Omega, trend, rounds) in enumerate(zip(*columns, strict=True)):
        rows.append(
            {
                "speed_over_f1": over_f1,
                "rpm": RPM * Omega,
                "trend": trend,
                "missed": float(shapes.missed[speed]),
            }
        )
        if kept[speed]:
            a = {n: with_rotation(u @ shapes.onto) for n, u in kept[speed].items()}
            found[speed] = at = stressed.worst(Omega, a)
            rows[-1] |= stressed.numbers(at) | {"revolution": at.number}
            if blade.fatigue:
                last = recorded(sweep["motion"].values[speed])
                k = at.stress.order(with_rotation(last @ shapes.onto))
                rows[-1] |= {
                    "cycles": k * ceil(rounds),
                    "endurance_s": 2 * np.pi * ENDURED / (k * Omega),
                }
    moving = [speed for speed in found if rows[speed]["alternating"] > LEAST]
    most = min(moving, key=lambda speed: reserve(rows[speed]), default=None)
    fields = {"away from clamp and contact": stressed.airfoil[0].astype(float)}
    for speed in sorted({*(peak.index for peak in asked(sweep, rom)), most} & {*moving}):
        rows[speed] |= stressed.around(found[speed])
        rows[speed] |= stressed.nearer(found[speed]) if speed == most else {}
        rpm, everywhere = f"{rows[speed]['rpm']:.0f} rpm", stressed.everywhere(found[speed])
        fields |= {f"{LABELS[label]}, {rpm}": everywhere[label] for label in everywhere}
    cells, points = grid_of(solid)
    save_vtu(points, cells, fields, vtu)
    return {
        **names,
        **stressed.read,
        "fatigue": blade.fatigue and blade.fatigue.model_dump(mode="json", exclude_none=True),
        "worst": None if most is None else rows[most]["speed_over_f1"],
        "speeds": rows,
    }


def revolutions(sweep: Sweep) -> list[Revolutions]:
    """Reduced displacements (times, n) of the revolutions kept of each run; none without a result.

    Those that strain the blade most, at some instants, and where it is none of them the last.
    """
    names = ("status", "rounds", "motion", "strained_round", "strained")
    if missing := {*names} - {*sweep.variables}:
        raise ProvenanceError(f"sweep.nc has no {', '.join(sorted(missing))}: make the sweep anew")
    runs = []
    for status, rounds, of_last, which, strained in zip(
        *(sweep[name].values for name in names), strict=True
    ):
        kept = {ceil(rounds): of_last} | dict(
            zip(which.astype(int).tolist(), strained, strict=True)
        )
        known = {n: recorded(u) for n, u in kept.items() if n and status in WITH_RESULT}
        runs.append({n: u for n, u in known.items() if len(u)})
    return runs


def recorded(u: NDArray[np.float32]) -> NDArray[np.float64]:
    """Those of states (times, n) that are recorded."""
    return u[~np.isnan(u).any(axis=1)].astype(float)


@dataclass(frozen=True)
class Found:
    """A node in one of the revolutions of a run, which are kept beside it."""

    Omega: float  # rad/s
    node: int
    number: int  # of the revolution
    revolutions: Revolutions  # amplitudes (times, 1 + shapes), the first 1, of rotation
    stress: NodeStress

    @property
    def a(self) -> NDArray[np.float64]:
        """Amplitudes (times, 1 + shapes) of its revolution."""
        return self.revolutions[self.number]


@dataclass(frozen=True)
class Stressed:
    """The blade, and the stress of rotation and of the shapes of its motion at all nodes."""

    blade: Blade
    solid: Solid
    basis: Basis
    shapes: Shapes
    sigma: NDArray[np.float64]  # as of ``stresses``

    @cached_property
    def points(self) -> NDArray[np.float64]:
        """Nodes (nodes, 3), m."""
        return self.solid.V.tabulate_dof_coordinates()

    @cached_property
    def near_clamp(self) -> NDArray[np.int64]:
        """Nodes between half the distance from the clamp and those whose stress is read."""
        inside, distance = self.airfoil
        return np.flatnonzero(away(self.solid, distance / 2) & ~inside)

    @cached_property
    def airfoil(self) -> tuple[NDArray[np.bool_], float]:
        """Nodes whose stress is read, and their least distance from the clamp, m."""
        return airfoil(self.solid, self.blade.stress)

    @cached_property
    def five(self) -> NDArray[np.float32]:
        """Components (powers, 1 + shapes, nodes, 5) of these nodes, for bounds."""
        return (self.sigma[:, :, self.airfoil[0]] @ FIVE.T).astype(np.float32)

    def at(self, Omega: float, nodes: Any = slice(None)) -> NDArray[np.float64]:
        """Stress (1 + shapes, ..., 6), Pa, at a speed at ``nodes``."""
        return evaluate(self.sigma[:, :, nodes], Omega / self.basis.Omega_m)

    def worst(self, Omega: float, revolutions: Revolutions) -> Found:
        """The worst node of the airfoil at a speed, rad/s, and its revolution."""
        powers = (Omega / self.basis.Omega_m) ** (2.0 * np.arange(len(self.five)))
        five = np.tensordot(powers.astype(np.float32), self.five, 1)
        of, nodes = [*revolutions.values()], np.flatnonzero(self.airfoil[0])
        node, which = worst(five, lambda few: self.at(Omega, nodes[few]), of, self.blade.fatigue)
        return self.found(Omega, nodes[node], [*revolutions][which], revolutions)

    def found(self, Omega: float, node: int, number: int, revolutions: Revolutions) -> Found:
        """A node in a revolution."""
        return Found(
            Omega=Omega,
            node=int(node),
            number=number,
            revolutions=revolutions,
            stress=NodeStress(self.at(Omega, node), self.blade.fatigue),
        )

    def numbers(self, found: Found) -> dict[str, Any]:
        """The numbers of a node, and its place: in axes and unit of the blade's file, and in m."""
        at, drawn = self.points[found.node], self.blade.drawn
        place = {"at": to_file(at, drawn).tolist(), "unit": drawn.unit, "at_m": at.tolist()}
        return found.stress.numbers(found.a) | place

    def everywhere(
        self, found: Found, nodes: Any = slice(None), precision: Any = np.float32
    ) -> dict[str, NDArray[np.float64]]:
        """The numbers of a revolution at all nodes, or some."""
        sigma, a = (of.astype(precision) for of in (self.at(found.Omega, nodes), found.a))
        return numbers(*cycles(sigma, a), self.blade.fatigue)

    def around(self, found: Found) -> dict[str, Any]:
        """What the numbers of a node are worth.

        The end of the airfoil towards which they `rises` further, if any; by how much the node
        `stands_out` of those around it; relative errors by the `mesh`; the alternating stress
        `between` any two instants of all revolutions; its stress over the reduced displacements,
        `sigma`, by which that of other runs is known.
        """
        near = around(self.solid, found.node)
        of_near = self.everywhere(found, near, float)
        left, itself = reserve(of_near), near == found.node
        radius = norm(self.points[near, :2], axis=1)
        beyond = np.where(self.airfoil[0][near] | (left >= left[itself]), np.inf, left)
        end = CLAMP if radius[beyond.argmin()] < radius[itself] else CONTACT
        others = of_near["alternating"][~itself].max()
        of_all = np.concatenate([*found.revolutions.values()])
        sigma = found.stress.sigma
        return {
            "rises": end if np.isfinite(beyond).any() else "",
            "stands_out": float(of_near["alternating"][itself].item() / others),
            "mesh": self.mesh_errors(found),
            "between": found.stress.numbers(of_all)["alternating"],
            "sigma": np.vstack([sigma[:1], self.shapes.onto @ sigma[1:]]).tolist(),
        }

    def mesh_errors(self, found: Found) -> dict[str, float]:
        """Relative errors by the mesh: by the ``disagreement`` of cells.

        That of the margin is of both stresses, were they higher by theirs.
        """
        five = found.a @ found.stress.sigma @ FIVE.T
        one, other = found.a[largest_change(five.T[None])[:, 0], 1:]
        shapes = self.shapes.shapes @ np.stack([one + other, one - other], axis=1) / 2
        order = dofs_at(self.basis.coordinates, self.solid.free_coordinates()).ravel()
        u, along = self.basis.static(found.Omega)[order], (self.basis.T @ shapes)[order].T
        off = disagreement(self.solid, u, along, self.blade.prestress, found.node)
        own = found.stress.numbers(found.a)
        mean = np.copysign(abs(own["mean_stress"]) + off[0] + off[1], own["mean_stress"])
        higher = numbers(mean, own["alternating"] + off[2], self.blade.fatigue)
        return {
            name: float(abs(value - own[name]) / max(abs(own[name]), NONE))
            for name, value in higher.items()
        }

    def nearer(self, found: Found) -> dict[str, Any]:
        """The worst node `nearer` to a sharp clamp, up to half the distance, if it is resolved."""
        asked = self.blade.stress
        if asked.root != "sharp" or asked.away_mm or not len(self.near_clamp):
            return {}
        node = self.near_clamp[reserve(self.everywhere(found, self.near_clamp)).argmin()]
        other = self.found(found.Omega, node, found.number, found.revolutions)
        errors = self.mesh_errors(other)
        agrees = errors["alternating"] <= AGREE
        return {"nearer": self.numbers(other) | {"mesh": errors}} if agrees else {}

    @property
    def read(self) -> dict[str, Any]:
        """Where stress is read, and the edges of the tip, m, in the blade's frame.

        `too_near`: half the thickness, where it is read nearer to a sharp clamp.
        """
        root, distance = self.blade.stress.root, self.airfoil[1]
        half = thickness(self.solid) / 2 if root == "sharp" else 0.0
        tip = self.points[self.solid.tip.ravel()]
        edges = {"LE": tip[tip[:, 2].argmin()].tolist(), "TE": tip[tip[:, 2].argmax()].tolist()}
        return {
            "root": root,
            "away_m": distance,
            "too_near": half if distance < half else None,
            "edges": edges,
        }
