"""Flap frequencies of a rotating cantilever: the table of Wright, Smith, Thresher and Wang."""

from collections.abc import Iterator

from cases import Case, Row
from rotating_beam import PUBLISHED, frequencies

from fem.prestress import nonlinear_states


def rows() -> Iterator[Row]:
    """Printed numbers by hub radius and speed."""
    for hub in (0, 1):
        etas = [eta for radius, eta in PUBLISHED if radius == hub]
        for eta, found in zip(etas, frequencies(nonlinear_states, hub, etas)["flap"], strict=True):
            for mode, (theirs, ours) in enumerate(zip(PUBLISHED[hub, eta], found, strict=False), 1):
                yield Row(
                    f"mu of flap mode {mode}, hub {hub} L, eta {eta}", theirs, float(ours), 1e-3
                )


CASE = Case(
    title="Rotating beam (Wright et al.)",
    source="Wright, Smith, Thresher, Wang, J. Appl. Mech. 49 (1982) 197; also the case of Bir "
    "(2009) in pyBmodes",
    compared="Cantilever of quadratic tetrahedra, 1 x 0.008 x 0.01 m, `nonlinear` prestress; "
    "mu = omega / U and eta = Omega / U with U = sqrt(E I / (rho A L^4)).",
    reason="shear, rotary inertia and strain of a beam of 100 thicknesses, which the source leaves "
    "out, take up to 0.06 % (mode 3).",
    rows=rows,
)
