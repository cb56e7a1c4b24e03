"""Flap frequencies of a rotating cantilever: the table of Wright, Smith, Thresher and Wang."""

from collections.abc import Iterator

from cases import Case, Row
from rotating_beam import FLAP_THICKNESS, LAG_THICKNESS, PUBLISHED, frequencies, lag

from fem.prestress import nonlinear_states


def rows() -> Iterator[Row]:
    """Printed numbers of flap by hub radius and speed, and lag, of which mu^2 is less by eta^2."""
    for hub in (0, 1):
        etas = [eta for radius, eta in PUBLISHED if radius == hub]
        found = frequencies(nonlinear_states, hub, etas)
        for eta, of_flap, of_lag in zip(etas, found["flap"], found["lag"], strict=True):
            at = f"hub {hub} L, eta"
            for mode, (theirs, ours) in enumerate(
                zip(PUBLISHED[hub, eta], of_flap, strict=False), 1
            ):
                yield Row(f"mu of flap mode {mode}, {at} {eta}", theirs, float(ours), 1e-3)
            faster = eta * FLAP_THICKNESS / LAG_THICKNESS  # over the lower stiffness of lag
            expected = float(lag(hub, faster)[0])
            yield Row(f"mu of lag mode 1, {at} {faster:g}", expected, float(of_lag[0]), 1e-3)


CASE = Case(
    title="Rotating beam (Wright et al.)",
    source="Wright, Smith, Thresher, Wang, J. Appl. Mech. 49 (1982) 197; also the case of Bir "
    "(2009) in pyBmodes",
    compared="Cantilever of quadratic tetrahedra, 1 x 0.008 x 0.01 m, `nonlinear` prestress; "
    "mu = omega / U and eta = Omega / U with U = sqrt(E I / (rho A L^4)). Lag by a Ritz "
    "solution that has the printed digits of flap.",
    reason="shear, rotary inertia and strain of a beam of 100 thicknesses, which the source leaves "
    "out, take up to 0.06 % (mode 3).",
    rows=rows,
)
