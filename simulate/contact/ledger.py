"""Energy ledger of a run: work of the casing, and its use by liner and blade.

Each step is taken in two moves: first the casing brings the rods under the tip, at the old
displacement; then the blade moves. With psi(eps) the elastic energy and plastic work that take a
rod from its state before the step to strain eps, summed over the rods under the tip:

    casing work     psi(old displacement) - elastic energy before + released
    released        elastic energy of the rods that left the footprint
    elastic         energy left in the rods under the tip
    plastic         work that wears
    work            of the contact forces on the blade
    on_casing       of the contact forces on the motion of a casing that is not rigid
    friction        work of the tangential forces on blade and casing, where the tip slides with
                    friction
    numerical       work + on_casing - friction + elastic + plastic + released - casing

The ledger is of all liner that comes under the tip, whether a step sees it there or not: a rod that
comes and goes within a step, and the area that bears in none where the footprint is lengthened
(``Strips.lengthened``), gets and gives up the energy of the rods beside it.

Only the last term is found by subtraction: the energy that the scheme creates (> 0) or loses.
Blade alone: energy(end) - energy(start) + damping = work + force, to round-off, with

    central differences  E(n+1/2) = w.M w/2 + u_n.K u_{n+1}/2, w = (u_{n+1} - u_n)/h,
                         work F_n.(u_{n+1} - u_{n-1})/2, damping h v_n.D v_n
    piecewise-exact      E_n = v.M v/2 + u.K u/2, work F.(u_{n+1} - u_n), damping the exact integral
"""

from dataclasses import dataclass

from simulate.contact.compiled import compiled, compiled_not_inlined
from simulate.contact.strips import covered_part, offset, part_ahead

CASING, PLASTIC, RELEASED, WORK, DAMPING, FRICTION, HEAT, ON_CASING = range(8)
WORN = 8  # beside the energies: volume worn off, m3
SUMS = 9


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
    blade_before: float = 0.0  # energy of the blade at the start
    elastic_before: float = 0.0  # in the rods under the tip at the start
    friction: float = 0.0  # of work: that of the tangential forces of a sliding tip
    heat: float = 0.0  # of friction, from the shaft, whose work is heat + friction
    # of a casing that moves
    on_casing: float = 0.0  # of the contact forces on its motion
    casing_kinetic: float = 0.0  # energy at the end
    casing_elastic: float = 0.0  # energy at the end
    casing_damping: float = 0.0  # dissipated in it
    casing_before: float = 0.0  # its energy at the start
    force: float = 0.0  # work of the engine orders that excite the blade beside the rub
    fed: float = 0.0  # less in damping: what the modes of a damping below 0 were given

    @property
    def given(self) -> float:
        """Energy given to blade and liner, J, at the start and by all but the scheme."""
        return self.casing + self.elastic_before + max(self.force, 0.0) + self.fed

    @property
    def stored_before(self) -> float:
        """Energy of blade and casing at the start, J."""
        return self.blade_before + self.casing_before

    @property
    def numerical(self) -> float:
        """Created (> 0) or lost (< 0) by the scheme in contact, J."""
        stored = self.elastic - self.elastic_before
        radial = self.work + self.on_casing - self.friction
        return radial + stored + self.plastic + self.released - self.casing


@compiled
def elastic_energy(sigma, eps, eps_p):
    """Elastic energy of a rod, J/m3: it unloads linearly."""
    return sigma * (eps - eps_p) / 2


@compiled
def plastic_work(law, before, after):
    """Work, J/m3, that takes a rod from the plastic strain ``before`` to ``after``."""
    return law.plastic_work(law.parameters, before, after) if after > before else 0.0


@compiled
def psi(law, eps, eps_p):
    """Elastic energy and plastic work that take a rod from ``eps_p`` to strain ``eps``, J/m3."""
    sigma, after, _ = law.stress(law.parameters, eps, eps_p)
    return elastic_energy(sigma, eps, after) + plastic_work(law, eps_p, after)


@compiled
def book_released(strips, covered, i, j, passed, a, energies):
    """Book the energy of rods that the tip leaves, its window on strip ``i`` going to rod ``j``.

    Rods not displaced by the casing since the last step keep their elastic energy. Returns the
    first rod that the casing has moved.
    """
    strip, rods = covered.strips[i], covered.rods
    if strip.stored == 0.0:
        return 0
    last, nu = rods.shape[1] - 1, strips.d.size
    ahead = (j - strip.at) % nu
    if 2 * ahead > nu:  # the tip swings back faster than the blade turns
        ahead -= nu
    released = gained = 0.0
    for k in range(strip.low, strip.high):  # no other stores energy
        change = covered_part(strips, i, k - ahead, passed) - rods[i, k].part
        released += max(-change, 0.0) * rods[i, k].stored
        gained += max(change, 0.0) * rods[i, k].stored
    slid = ahead + passed - strip.passed
    if abs(slid) > strips.length[i] - 1:
        both = come_and_gone(
            rods[i, strip.low : strip.high],
            offset(strips, strip.low, strip.passed),
            slid,
            strips.length[i],
        )
        released += both
        gained += both
    volume, fresh = strips.area[i] * strips.thickness, 0
    # under a tip that is rounded or leans, or while the casing grows, the penetration of every rod
    # changes; where the window goes all around, the wear of its last rod is also that of its first
    level = strips.tip.half[i] == 0.0 and len(strips.rows) == 1
    if level and a == strip.ramp and ahead >= 0 and last < nu:
        covered_end = last + 1
        while covered_end > 0 and rods[i, covered_end - 1].part == 0.0:
            covered_end -= 1
        fresh = max(covered_end - ahead, 0)
    else:
        gained = released - strip.stored
    energies[RELEASED] += released * volume * strips.lengthened[i]
    energies[CASING] += (gained + (strips.lengthened[i] - 1) * released) * volume
    return fresh


@compiled_not_inlined
def come_and_gone(rods, first, slid, length):
    """Energy, J/m3, of parts of ``rods`` that come under the tip while as much of the rod leaves.

    Where the footprint slides by more than it has beyond one rod.

    Parameters
    ----------
    first : distance of the first rod from the camber line before it slides, rods
    slid, length : of the footprint, rods
    """
    energy = 0.0
    for k in range(len(rods)):
        x = first + k
        ahead = abs(part_ahead(x - slid, length) - part_ahead(x, length))
        behind = abs(part_ahead(slid - x, length) - part_ahead(-x, length))
        energy += min(ahead, behind) * rods[k].stored
    return energy
