"""Loads of a rub on rotor and casing: force, torque, worn volume, mean worn depth.

Under a flat tip the torque that keeps the rotor at its speed follows from the energy ledger: at
constant Omega the casing, which turns past the blade, does the work T Omega dt on the rods, so that
the mean torque of a revolution is that work over 2 pi. While the casing distorts, the work of its
growth on the rods under the tip is part of it. With a profile and its tangential force it is the
moment of that force: there the ledger's error goes with the step, as rods leave at the depth of
their last step. Friction adds its moment. With a profile but no tangential force, and with
harmonics of the casing that travel, which do work of their own, the model has no torque.
"""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from geometry.hats import middles
from simulate.scene import Scene
from simulate.signals import filled

if TYPE_CHECKING:  # slow imports, which Snakemake does without
    from rom.model import Rom
    from simulate.marching import Outcome

FULL_TURN = 2 * np.pi


def torque(casing_work: NDArray[np.float64], rounds: float = 1.0) -> NDArray[np.float64]:
    """Mean torque on the rotor, against the rotation, N m.

    ``casing_work``: work of the casing on the rods, J, in so many ``rounds``.

    >>> float(torque(np.array(2 * np.pi * 3.0)))
    3.0
    """
    return np.asarray(casing_work) / FULL_TURN / rounds


def torque_of_rounds(scene: Scene, rom: "Rom", outcome: "Outcome") -> NDArray[np.float64]:
    """Mean torque (revolutions,), N m, in each revolution of a run; nan where not computed.

    Of all blades. With a tangential force or friction the forces must have been recorded.
    """
    blades = outcome.each_blade
    work = np.sum([blade.casing_work for blade in blades], axis=0)
    along = np.sum([blade.force_tangential_mean for blade in blades], axis=0)
    computed = torque(work), tangential_moment(along, rom)
    of_work, moment = (filled(values, scene.rounds) for values in computed)
    if scene.contact.tangential:
        return moment
    return of_work if scene.contact.friction is None else of_work + moment


def tangential_moment(on_shares: NDArray[np.float64], rom: "Rom") -> NDArray[np.float64]:
    """Moment (...,), N m, of tangential forces (..., shares), N, on equal parts of the chord."""
    radius, _, _ = rom.line(middles(on_shares.shape[-1])).T
    return on_shares @ radius


def worn_volume(
    wear: NDArray[np.floating], width: NDArray[np.float64], radius: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Volume (...,), m3, of worn depths ``wear`` (..., m, nu), m.

    ``width`` and ``radius`` (m,), m: axial width and radius of the strips.

    >>> wear = np.full((2, 8), 1e-4)  # two strips worn all around
    >>> round(float(worn_volume(wear, np.array([0.02, 0.01]), np.array([0.5, 0.5]))), 12)
    9.425e-06
    """
    from simulate.contact.places import volume_of  # as above

    return volume_of(wear.mean(axis=-1, dtype=float), width, radius)


def mean_opening(
    wear: NDArray[np.floating], width: NDArray[np.float64], radius: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Mean growth (...,), m, of the clearance: worn volume over the area that the tip sweeps.

    As of ``worn_volume``.
    """
    return worn_volume(wear, width, radius) / (FULL_TURN * width @ radius)


def worn_per_pass(
    worn: NDArray[np.float64],
    width: NDArray[np.float64],
    radius: NDArray[np.float64],
    blades: int = 1,
) -> float:
    """Mean depth, m, by which a passage of a tip opens the clearance: of whole revolutions.

    ``worn`` (revolutions,), m3: volume worn in each by so many ``blades``; nan in those that did
    not end. 0 without any.

    >>> worn = np.array([3e-6, 1e-6, np.nan])  # of an area of 0.1 m2
    >>> round(worn_per_pass(worn, np.array([0.05]), np.array([1 / np.pi])), 12)
    2e-05
    """
    whole = worn[np.isfinite(worn)]
    return float(whole.sum() / max(len(whole), 1) / (FULL_TURN * width @ radius) / blades)


def mean_force(on_shares: NDArray[np.float64]) -> NDArray[np.float64]:
    """Mean force (...,), N, on the whole chord, over the revolutions computed.

    ``on_shares`` (..., revolutions, shares), N: means of each revolution on the parts of the chord;
    nan in revolutions that were not computed.
    """
    return np.nanmean(on_shares.sum(axis=-1), axis=-1)
