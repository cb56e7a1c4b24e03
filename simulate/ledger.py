"""Energy ledger of a run: what the casing puts in, what the liner and the blade do with it.

Each step is taken in two moves: first the casing brings the rods under the tip, at the old
displacement; then the blade moves. With psi the energy that a rod's law takes from its state before
the step (elastic energy and plastic work), summed over the rods under the tip:

    casing work     psi(old displacement) - elastic energy before + released
    released        elastic energy of the rods that left the footprint
    elastic         energy left in the rods under the tip
    plastic         work that wears
    work            of the contact forces on the blade
    numerical       work + elastic + plastic + released - casing

No term is found by subtraction but the last, which is what the scheme creates (> 0) or loses.
Blade alone: energy(end) - energy(start) + damping = work, to round-off, with

    central differences  E(n+1/2) = w.M w/2 + u_n.K u_{n+1}/2, w = (u_{n+1} - u_n)/h,
                         work F_n.(u_{n+1} - u_{n-1})/2, damping h v_n.D v_n
    piecewise-exact      E_n = v.M v/2 + u.K u/2, work F.(u_{n+1} - u_n), damping the exact integral
"""

from dataclasses import dataclass

CASING, PLASTIC, RELEASED, WORK, DAMPING = range(5)
BOOKS = 5


@dataclass(frozen=True)
class Ledger:
    """Energies of a whole run, J."""

    casing: float  # work of the casing on the rods
    work: float  # of the contact forces on the blade
    blade: float  # energy of the blade at the end
    damping: float  # dissipated in the blade
    elastic: float  # in the rods under the tip at the end
    plastic: float  # spent on wear
    released: float  # lost with rods that left the footprint

    @property
    def numerical(self) -> float:
        """Created (> 0) or lost (< 0) by the scheme in contact, J."""
        return self.work + self.elastic + self.plastic + self.released - self.casing

    @property
    def identity(self) -> float:
        """Error of the blade's own balance, J: round-off."""
        return self.blade + self.damping - self.work
