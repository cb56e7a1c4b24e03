"""Second order of a vibration: the radial displacement of the tip that goes with its square.

A blade that bends shortens. A vibration w about an equilibrium, held as it is, brings with it a
displacement of second order, that under the forces -1/2 D3(w, w, .), D3 the third derivative of the
strain energy. Along a load R it is

    R u2 = -1/2 D3(w, w, x) = -1/2 w K_G w,    K x = R,

K_G the change of the tangent stiffness by the displacements x of the load: geometric stiffness. The
motion w itself is not among them: x is without it. Of a beam's first mode it is -0.581 w^2/L, w at
the tip, L the length.
"""

import numpy as np
from numpy.typing import NDArray

import ufl
from dolfinx import fem

from fem.forms import compiled
from fem.solid import Solid


class SecondOrder:
    """-1/2 D3(w, w, x) about equilibria of a blade, compiled once."""

    def __init__(self, solid: Solid, prestress: str) -> None:
        """Of a ``solid`` with this ``prestress``: with `linear` about its shape at rest."""
        self._nonlinear, self._free = prestress == "nonlinear", solid.free
        u, x, w = self._fields = [fem.Function(solid.V) for _ in range(3)]
        F = ufl.Identity(3) + ufl.grad(u)

        def product(a: fem.Function, b: fem.Function) -> ufl.core.expr.Expr:
            """Second derivative of the strain E, Eq. (b), along two displacements."""
            return ufl.sym(ufl.grad(a).T * ufl.grad(b))

        def strain(a: fem.Function) -> ufl.core.expr.Expr:
            """First derivative of E along a displacement."""
            return ufl.sym(F.T * ufl.grad(a))

        third = ufl.inner(solid.stress(product(w, w)), strain(x))
        third += 2 * ufl.inner(solid.stress(product(w, x)), strain(w))
        self._form = compiled(-third / 2 * solid.dx)

    def along(
        self, u: NDArray[np.float64], x: NDArray[np.float64], w: NDArray[np.float64]
    ) -> float:
        """R u2 for the static deflection ``u``, x = K^-1 R, and the motion ``w`` (free DoFs)."""
        for field, values in zip(self._fields, (u * self._nonlinear, x, w), strict=True):
            field.x.array[self._free] = values
        return float(np.real(fem.assemble_scalar(self._form)))  # pyright: ignore[reportArgumentType]  one form
