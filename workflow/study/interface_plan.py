"""What the study of the interface compares: scenes, reduced models, and the bar of each change."""

from typing import NamedTuple

from simulate.scene import STRIPS
from workflow.study import trade_plan
from workflow.study.trade_plan import FLAT, TILTED, Studied

SCENES = trade_plan.SCENES | {"tilted": Studied("paper-tilted", 0.31, tip=TILTED)}
STEPS = {FLAT: 2**15, TILTED: 2**14}  # per round
RODS = {FLAT: 4093, TILTED: 308411}
MODES, RICH = 24, 36  # natural modes: the default, and half as many more


class Reduction(NamedTuple):
    """A reduced model of the study."""

    blade: str
    patches: int = 16
    modes: int = MODES
    directions: str = "r"

    @property
    def file(self) -> str:
        """Where it is."""
        return f"results/interface/{self.blade}/{self.patches}-{self.modes}-{self.directions}.nc"


COARSE, DEFAULT, FINE = map(Reduction, ("reference-coarse", "reference", "reference-fine"))
TWICE, ENRICHED = DEFAULT._replace(patches=32), DEFAULT._replace(modes=RICH)
MARCHED = (COARSE, DEFAULT, FINE, TWICE, ENRICHED)
# The first of a blade and its patches is the one whose operators are checked.
REDUCTIONS = (
    *MARCHED,
    *(model._replace(directions="rt") for model in MARCHED),
    *(model._replace(patches=8) for model in (COARSE, DEFAULT, FINE)),
    *(Reduction(blade, patches) for blade in ("rotor37", "rotor37-fine") for patches in (8, 16)),
)
BLADES = tuple(dict.fromkeys(model.blade for model in REDUCTIONS))
STRESSED = (DEFAULT, FINE, TWICE)  # whose stress is compared


class Compared(NamedTuple):
    """Two models, their strips, and by observable the largest change from one to the other."""

    one: Reduction
    other: Reduction
    bars: dict[str, float]
    strips: tuple[int, int] = (STRIPS, STRIPS)


COMPARED = {
    "3.51 to 2.48 mm": Compared(
        COARSE, DEFAULT, {"wear": 0.015, "amplitude": 0.003, "Omega_c": 0.0005}
    ),
    "2.48 to 1.75 mm": Compared(
        DEFAULT, FINE, {"wear": 0.01, "amplitude": 0.003, "Omega_c": 0.0005}
    ),
    "16 patches, 16 strips to 32, 32": Compared(
        DEFAULT, TWICE, {"wear": 0.03, "volume": 0.01}, (STRIPS, 2 * STRIPS)
    ),
    "24 to 36 natural modes": Compared(DEFAULT, ENRICHED, {"wear": 0.005}),
}
TOLD = ("wear", "volume", "amplitude", "Omega_c", "force")
MESHES = (  # each with the next finer, and whether its change is judged
    ("reference-coarse", "reference", False),
    ("reference", "reference-fine", True),
    ("rotor37", "rotor37-fine", True),
)
COMPLIANCE_BARS = {8: 0.003, 16: 0.006}  # by patches
OPERATOR_BARS = {"constant": 1e-8, "linear": 1e-8, "ST": 1e-9, "compliance_of_model": 1e-6}
FREQUENCY_BAR, STRESS_BAR = 1e-4, 0.03
