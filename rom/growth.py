"""Static growth of the tip with speed: its radius at the equilibrium less that at rest."""

import numpy as np
from numpy.typing import NDArray

from fem.matrices import Matrices
from rom.polynomial import interpolate


def growth_of(fom: Matrices) -> NDArray[np.float64]:
    """Coefficients (powers, n), m, of the growth on the patches, or at the points, of ``fom``.

    The radius of each node, |x + u| less |x| across the engine axis, is projected like a radial
    displacement: an untwist that moves a node sideways by t counts with t^2 / (2 r). (0, n) where
    the static deflections are not known.
    """
    if np.isnan(fom.u_static).any():
        return np.empty((0, len(fom.xi)))
    if not fom.u_static.any():
        return np.zeros((len(fom.u_static), len(fom.xi)))
    x, y = fom.coordinates[:, 0], fom.coordinates[:, 1]
    r = np.hypot(x, y)
    e_r = np.stack([x / r, y / r, 0 * r], axis=1)
    S_r = fom.S[::3]
    at_speeds = []
    for u in fom.u_static.reshape(len(fom.u_static), -1, 3):
        grown = np.hypot(x + u[:, 0], y + u[:, 1]) - r
        at_speeds.append(S_r @ (grown[:, None] * e_r).ravel())
    return interpolate(np.array(at_speeds), fom.speeds)
