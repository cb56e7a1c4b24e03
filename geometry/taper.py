"""Taper of the tip: the slope s = dr/dz along its chord, that of the casing which it follows.

On a casing of slope s = tan g the outward normal is (cos g, -sin g) in (r, z). What closes a gap
measured along the radius is u_r - s u_z.
"""

import numpy as np
from numpy.typing import NDArray

FLAT = 1e-5  # m, from one plane: a tip within was cut by a plane
LEAST = 0.002  # smaller slopes count as 0: they change what closes the gap by less than 3 %


def slope_of_line(r: NDArray[np.float64], z: NDArray[np.float64]) -> NDArray[np.float64]:
    """Slope dr/dz (places,) of a line of radii ``r`` (places,), m, at ascending ``z``, m."""
    return counted(np.gradient(r, z))


def slope_of_tip(nodes: NDArray[np.float64], line: NDArray[np.float64]) -> NDArray[np.float64]:
    """Slope dr/dz (places,) of a tip with ``nodes`` (n, 3), m, and the camber ``line``.

    A tip that was cut by a plane has the slope of that plane: the radius of its line changes with
    the angle, too, which is no taper.
    """
    centred = nodes - nodes.mean(axis=0)
    normal = np.linalg.svd(centred, full_matrices=False)[2][-1]
    if len(nodes) < 4 or abs(centred @ normal).max() > FLAT:
        return slope_of_line(line[:, 0], line[:, 2])
    theta = line[:, 1].mean()
    outward = normal[:2] @ [np.cos(theta), np.sin(theta)]
    return counted(np.full(len(line), -normal[2] / outward))


def counted(slope: NDArray[np.float64]) -> NDArray[np.float64]:
    """The slope, 0 where it is less than ``LEAST``."""
    return np.where(abs(slope) < LEAST, 0.0, slope)
