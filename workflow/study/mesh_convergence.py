"""What the mesh costs in accuracy: limits of the frequencies and of the tip deflection.

Celik, Ghia, Roache and others (2008), Procedure for estimation and reporting of uncertainty due to
discretization, J. Fluids Eng. 130: an order p observed on the three finest sizes, Richardson's
limit from the two finest, and a band of 1.25 times what that step adds. Unstructured meshes
scatter, so one order is fitted to all frequencies together. In the limit the clamp sets it: at a
clamped edge of 90 degrees stress grows as r^-0.3 (Williams, 1952), which leaves frequencies an
order of 1.4.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import minimize_scalar

from workflow.markdown import table
from workflow.study.mesh_level import MODES, OWN, Level

ORDERS = (0.5, 4.0)  # searched; frequencies of quadratic elements gain no more than 4
SAFETY = 1.25  # of Celik and others, for three sizes and an observed order


def common_order(sizes: ArrayLike, values: ArrayLike) -> float:
    """Order p for which values (sizes, quantities) are nearest to limit + slope size^p.

    Least squares over all quantities, relative to each; limit and slope are each quantity's own.
    """
    sizes, values = np.asarray(sizes, dtype=float), np.asarray(values, dtype=float)

    def misfit(p: float) -> float:
        A = np.column_stack([np.ones_like(sizes), (sizes / sizes[-1]) ** p])
        left = values / values[-1] - A @ np.linalg.lstsq(A, values / values[-1])[0]
        return float((left**2).sum())

    return float(minimize_scalar(misfit, bounds=ORDERS, method="bounded").x)


def limits(sizes: ArrayLike, values: ArrayLike, order: float) -> NDArray[np.float64]:
    """Richardson's limit (quantities,) of values (sizes, quantities) from the two finest sizes."""
    coarse, fine = np.asarray(values, dtype=float)[-2:]
    ratio = sizes[-2] / sizes[-1]
    return fine + (fine - coarse) / (ratio**order - 1)


def summarise(levels: Sequence[Level]) -> dict[str, Any]:
    """Limits, and the errors of every size against them, of ``levels`` from coarse to fine."""
    sizes = [level.element_size_mm for level in levels]
    at_rest = np.array([level.at_rest_Hz for level in levels])
    at_speed = np.array([level.at_Omega_m_Hz for level in levels])
    tip = np.array([[level.tip_deflection_m] for level in levels])
    order = common_order(sizes[-3:], np.hstack([at_rest, at_speed])[-3:])
    return {
        "element_size_mm": sizes,
        "nodes": [level.nodes for level in levels],
        "order": order,
        "at_rest_Hz": _against_limit(sizes, at_rest, order),
        "at_Omega_m_Hz": _against_limit(sizes, at_speed, order),
        "tip_deflection_m": _against_limit(sizes, tip, order),
    }


def _against_limit(sizes: list[float], values: NDArray[np.float64], order: float) -> dict[str, Any]:
    limit = limits(sizes, values, order)
    error = values / limit - 1
    return {
        "limit": limit.tolist(),
        "error": error.tolist(),  # (sizes, quantities), relative to the limit
        "band": (SAFETY * abs(error[-1])).tolist(),  # of the limit, relative
    }


def markdown(summary: Mapping[str, Any]) -> str:
    """Render what the blade's own element size costs: sizes, then a row for each mode."""
    sizes, nodes = summary["element_size_mm"], summary["nodes"]
    pairs = ", ".join(f"{h:.2f} mm ({n:,} nodes)" for h, n in zip(sizes, nodes, strict=True))
    rest, speed = summary["at_rest_Hz"], summary["at_Omega_m_Hz"]
    head = ["mode", "limit at rest, Hz", "error, %", "limit at Ω_m, Hz", "error, %"]
    rows = [[m + 1, *_cells(rest, m), *_cells(speed, m)] for m in range(MODES)]
    tip = summary["tip_deflection_m"]
    return "\n".join(
        [
            f"Sizes {pairs}; observed order {summary['order']:.2f}. The blade's own size is "
            f"{sizes[OWN]:.2f} mm:",
            "",
            table(head, rows),
            "",
            "Deflection of the tip at 1/16 of the chord at Ω_m: limit "
            f"{1e3 * tip['limit'][0]:.4f} mm, error {_error(tip, 0)} %.",
        ]
    )


def _cells(quantity: Mapping[str, Any], m: int) -> tuple[str, str]:
    return f"{quantity['limit'][m]:.2f}", _error(quantity, m)


def _error(quantity: Mapping[str, Any], m: int) -> str:
    """Error of the blade's own size, and the band of the limit, %."""
    return f"{100 * quantity['error'][OWN][m]:+.2f} ± {100 * quantity['band'][m]:.2f}"
