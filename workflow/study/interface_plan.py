"""Plan of the study of the interface: scenes, reduced models, and the largest changes allowed."""

from typing import NamedTuple

from simulate.scene import STRIPS
from workflow.study import trade_plan
from workflow.study.trade_plan import FLAT, TILTED, Studied

SCENES = trade_plan.SCENES | {"tilted": Studied("hand-tilted", 0.31, tip=TILTED)}
STEPS = {FLAT: 2**13, TILTED: 2**13}  # per round
RODS = {FLAT: 4093, TILTED: 308411}
MODES, RICH = 24, 36  # natural modes: the default, and 1.5 times as many


class Reduction(NamedTuple):
    """A reduced model of the study."""

    blade: str
    patches: int = 16
    modes: int = MODES
    directions: str = "r"

    @property
    def file(self) -> str:
        """Path of its file."""
        return f"results/interface/{self.blade}/{self.patches}-{self.modes}-{self.directions}.nc"


COARSE, DEFAULT, FINE = map(Reduction, ("reference-coarse", "reference", "reference-fine"))
TWICE, ENRICHED = DEFAULT._replace(patches=32), DEFAULT._replace(modes=RICH)
MARCHED = (COARSE, DEFAULT, FINE, TWICE, ENRICHED)
# Operators are checked on the first model of each blade and number of patches.
REDUCTIONS = (
    *MARCHED,
    *(model._replace(directions="rt") for model in MARCHED),
    *(model._replace(patches=8) for model in (COARSE, DEFAULT, FINE)),
    *(Reduction(blade, patches) for blade in ("rotor37", "rotor37-fine") for patches in (8, 16)),
)
BLADES = tuple(dict.fromkeys(model.blade for model in REDUCTIONS))
STRESSED = (DEFAULT, FINE, TWICE)  # models whose stress is compared


class Compared(NamedTuple):
    """Two models, their strips, and the largest change allowed between them by observable."""

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
SHOWN = ("wear", "volume", "amplitude", "Omega_c", "force")  # in the tables
MESHES = (  # each mesh with the next finer one, and whether their difference is judged
    ("reference-coarse", "reference", False),
    ("reference", "reference-fine", True),
    ("rotor37", "rotor37-fine", True),
)
COMPLIANCE_BARS = {8: 0.003, 16: 0.006}  # by patches
OPERATOR_BARS = {"constant": 1e-8, "linear": 1e-8, "ST": 1e-9, "compliance_of_model": 1e-6}
FREQUENCY_BAR, STRESS_BAR = 1e-4, 0.03
