"""The blade's interface on its tip: patches along the chord, or the points of the basis `paper`."""

import numpy as np
from numpy.typing import NDArray

from geometry.base import require
from geometry.blade import Interface
from geometry.facets import nearest_facet, outward, shape_functions
from geometry.hats import hat_nodes, middles
from geometry.root_and_tip import outline_of
from geometry.tip import DevelopedTip, cartesian, on_line

APART = 0.25  # least extent of the mesh nodes under a hat, over the distance of two hat nodes
OFF_TIP = 1e-4  # m, largest distance of a listed point from the tip
OUTSIDE = 0.02  # of a facet, largest distance of a point beyond the polygonal outline


def tip_of(facets: NDArray, points: NDArray[np.float64]) -> DevelopedTip:
    """Chord and outline of the tip's ``facets`` (k, 6) between ``points`` (n, 3), m.

    Raises
    ------
    MeshError
        When the facets are not connected, or their outline folds over its chord.
    """
    return DevelopedTip.of(points[outline_of(outward(facets, points), points)])


def require_patches(n: int, xi: NDArray[np.float64]) -> None:
    """Refuse more patches than the mesh nodes at chord fractions ``xi`` resolve.

    Raises
    ------
    MeshError
        If there are more; the message names the number allowed.
    """
    carried = next((k for k in range(n, 1, -1) if _carries(k, xi)), 0)
    serves = f"allowed up to {carried}, or refine" if carried else "refine"
    require(
        (
            carried == n,
            "the mesh of the tip is too coarse for so many, fewer than two nodes along the "
            f"chord lie under one of them; {serves} the mesh of the tip",
        ),
        key="interface.patches",
        value=n,
        allowed={"le": carried},
    )


def _carries(n: int, xi: NDArray) -> bool:
    """Whether the mesh nodes under each of ``n`` hats extend over ``APART`` of their distance."""
    spacing = 1 / (n - 1)
    under = (xi[np.abs(xi - node) < spacing] for node in hat_nodes(n))
    return all(len(some) > 1 and np.ptp(some) >= APART * spacing for some in under)


def places_of(interface: Interface, tip: DevelopedTip) -> NDArray[np.float64]:
    """Places (n, 3), m, of an interface of points, leading edge first."""
    if interface.points_mm:
        return np.array(interface.points_mm) * 1e-3
    return cartesian(on_line(tip.camber_line(), middles(interface.nodes)))


def on_facets(
    points: NDArray[np.float64],
    facets: NDArray,
    tip: DevelopedTip,
    places: NDArray[np.float64],
) -> tuple[NDArray, NDArray[np.float64], NDArray[np.float64]]:
    """Put ``places`` (n, 3), m, on the tip's ``facets`` (k, 6) between ``points``, m.

    A place is located in the developed tip, and projected on the tip along the radius. Returned are
    the nodes (n, 6) of its facet, their shape functions there (n, 6), and the point (n, 3), m.

    Raises
    ------
    MeshError
        When a place is outside the outline of the tip, or farther than ``OFF_TIP`` from it.
    """
    developed = tip.developed(points)[facets]
    nearest = [nearest_facet(developed, place) for place in tip.developed(places)]
    nodes = facets[[number for number, _ in nearest]]
    values = shape_functions(np.array([x for _, x in nearest]))
    on_tip = np.einsum("nk,nkd->nd", values, points[nodes])
    for i, ((_, x), place) in enumerate(zip(nearest, places, strict=True)):
        off = float(np.linalg.norm(on_tip[i] - place))
        require(
            (
                min(x.min(), 1 - x.sum()) >= -OUTSIDE and off <= OFF_TIP,
                f"interface point {i + 1} lies {1e3 * off:.3g} mm off the tip or beside it; "
                f"allowed {1e3 * OFF_TIP:g} mm",
            )
        )
    return nodes, values, on_tip
