"""Text of a file with a law of one's own, perfectly plastic; it yields at 1.0 times its number."""

LAW = """
from simulate import Law


class Foam(Law):
    E: float
    sigma_Y: float

    def stress(law, eps, eps_p):
        sigma = law.E * (eps - eps_p)
        if sigma <= 0.0:
            return 0.0, eps_p, 0.0
        if sigma < 1.0 * law.sigma_Y:
            return sigma, eps_p, law.E
        return 1.0 * law.sigma_Y, eps - 1.0 * law.sigma_Y / law.E, 0.0

    def plastic_work(law, before, after):
        return 1.0 * law.sigma_Y * (after - before)
"""
