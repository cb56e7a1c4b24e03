"""A law that the march cannot rely on is refused, with what is wrong, before any run."""

import re
from math import exp

import numpy as np
import pytest
from refused import refused
from scenes import scene
from test_laws import SAMPLES, made

from simulate import Law, march
from simulate.contact.law_check import fault
from simulate.marching import SceneError


class Hardening(Law):
    """The plastic law again, from outside."""

    E: float = 2e9
    sigma_Y: float = 1e6
    H: float = 1e8

    def stress(law, eps, eps_p):  # noqa: N805
        sigma = law.E * (eps - eps_p)
        if sigma <= 0.0:
            return 0.0, eps_p, 0.0
        f = sigma - (law.sigma_Y + law.H * eps_p)
        if f <= 0.0:
            return sigma, eps_p, law.E
        after = eps_p + f / (law.E + law.H)
        return law.sigma_Y + law.H * after, after, law.E * law.H / (law.E + law.H)

    def plastic_work(law, before, after):  # noqa: N805
        return (after - before) * (law.sigma_Y + law.H * (before + after) / 2)


class Saturating(Hardening):
    """Voce's: the yield stress rises to sigma_Y + H; the plastic strain is found by iteration."""

    b: float = 300.0

    def stress(law, eps, eps_p):  # noqa: N805
        sigma = law.E * (eps - eps_p)
        if sigma <= 0.0:
            return 0.0, eps_p, 0.0
        if sigma <= law.sigma_Y + law.H * (1 - exp(-law.b * eps_p)):
            return sigma, eps_p, law.E
        after = eps_p
        for _ in range(60):
            decay = law.H * exp(-law.b * after)
            excess = law.E * (eps - after) - law.sigma_Y - law.H + decay
            after += excess / (law.E + law.b * decay)
        slope = law.b * law.H * exp(-law.b * after)
        return law.E * (eps - after), after, law.E * slope / (law.E + slope)

    def plastic_work(law, before, after):  # noqa: N805
        decay = (exp(-law.b * before) - exp(-law.b * after)) / law.b
        return (law.sigma_Y + law.H) * (after - before) - law.H * decay


plastic = Hardening.stress


def softening(law, eps, eps_p):
    sigma, limit = law.E * (eps - eps_p), law.sigma_Y * exp(-500 * eps_p)
    if sigma <= 0.0:
        return 0.0, eps_p, 0.0
    return (limit, eps - limit / law.E, 0.0) if sigma > limit else (sigma, eps_p, law.E)


def healing(law, eps, eps_p):
    sigma, after, tangent = plastic(law, eps, eps_p)
    return sigma, after if after > eps_p else 0.9 * eps_p, tangent


def degrading(law, eps, eps_p):
    """Perfectly plastic; unloads with E (1 - 50 eps_p)."""
    modulus = law.E * (1 - 50 * eps_p)
    sigma = modulus * (eps - eps_p)
    if sigma <= 0.0:
        return 0.0, eps_p, 0.0
    if sigma <= law.sigma_Y:
        return sigma, eps_p, modulus
    b = 1 + 50 * eps
    return law.sigma_Y, (b - (b**2 - 200 * (eps - law.sigma_Y / law.E)) ** 0.5) / 100, 0.0


STRESSES = {
    "unloads less steeply": (degrading, "unloads with .* Pa, not with the modulus of 2e.09 Pa"),
    "in another order": (lambda *a: tuple(np.roll(plastic(*a), 1)), "more than the total strain"),
    "two numbers": (lambda *a: plastic(*a)[:2], "expected 3, got 2.*it returns three numbers"),
    "one number": (lambda *a: plastic(*a)[0], "it returns three numbers"),
    "no number": (lambda *a: (float("nan"), 0.0, 0.0), "not finite"),
    "heals": (healing, "plastic strain changes from"),
    "softens": (softening, "stress falls from"),
    "pulls": (
        lambda law, eps, p: plastic(law, eps, p) if eps > p else (law.E * (eps - p), p, law.E),
        "where the gap is open",
    ),
    "unloads on a curve": (
        lambda law, eps, p: (law.E * (eps + eps**3), p, law.E * (1 + 3 * eps**2)),
        "not linear",
    ),
    "increment": (lambda law, eps, p: (plastic(law, eps, p)[0], plastic(law, eps, p)[1] - p, 0.0),
                  "tangent is 0 Pa, the derivative of the stress 2e.09"),
    "elastic tangent": (
        lambda law, eps, p: (*plastic(law, eps, p)[:2], law.E),
        "tangent is 2e.09 Pa, the derivative of the stress 9.5",
    ),
}  # fmt: skip


@pytest.mark.parametrize("law", [*map(made, SAMPLES), Hardening(), Saturating()], ids=str)
def test_a_law_that_keeps_to_what_the_march_relies_on_passes(law):
    assert fault(law) is None


work = Hardening.plastic_work
WRONG = {  # what of the class is wrong, and what is told
    **{name: ({"stress": staticmethod(law)}, told) for name, (law, told) in STRESSES.items()},
    **{
        f"work by {factor}": (
            {"plastic_work": staticmethod(lambda *a, by=factor: by * work(*a))},
            "plastic_work is",
        )
        for factor in (0.0, 0.5, 2.0)
    },
    "no work": ({"plastic_work": staticmethod(lambda *a: None)}, "plastic_work one"),
    "modulus": ({"modulus": property(lambda law: law.H)}, r"above the modulus of 1e\+08 Pa"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_law_is_refused_with_what_is_wrong(name):
    changed, message = WRONG[name]
    assert re.search(message, fault(type("Wrong", (Hardening,), changed)()))


def limit(law):
    """A function of Python that is not compiled."""
    return law.sigma_Y


@pytest.mark.filterwarnings("ignore::simulate.sweeps.unusual.SceneWarning")  # a modulus is none
@pytest.mark.parametrize(
    ("stress", "told"),
    [
        (softening, "stress falls from"),
        # what cannot be compiled says why in one line
        (lambda law, eps, p: (0.0 * limit(law), p, 0.0), r"Calls: .*Untyped global.*numba.njit"),
    ],
)
def test_a_wrong_law_is_a_fault_of_its_scene(coarse_rom, stress, told):
    wrong = type("Calls", (Hardening,), {"stress": staticmethod(stress)})
    case = scene(liner__law=wrong())
    refused(SceneError, march, case, coarse_rom, 500.0, match=f"liner.law: .*{told}")
