"""Plan of the study of the interface: scenes, reduced models, and the largest changes allowed."""

from typing import NamedTuple

from simulate.scene import STRIPS
from workflow.study import trade_plan
from workflow.study.trade_plan import BASIS_STUDY, FLAT, MESH_STUDY, TILTED, TWICE, Model, Studied

SCENES = trade_plan.SCENES | {"tilted": Studied("hand-tilted", 0.31, tip=TILTED)}
STEPS = 2**13  # per round
RODS = {FLAT: 4093, TILTED: 308411}
COARSE, DEFAULT, FINE = MESH_STUDY
ENRICHED = BASIS_STUDY[-1]  # 1.5 times the natural modes
MODELS = (COARSE, DEFAULT, FINE, TWICE, ENRICHED)  # that are marched
PATCHES = {  # numbers of patches whose operators are checked, by blade
    "reference-coarse": (8, 16),
    "reference": (8, 16, 32),
    "reference-fine": (8, 16),
    "rotor37": (8, 16),
    "rotor37-fine": (8, 16),
}
# Blades and patches whose stress is compared: the first with each of the others.
STRESSED = (("reference", 16), ("reference-fine", 16), ("reference", 32))


class Compared(NamedTuple):
    """Two models, their strips, and the largest change allowed between them by observable."""

    one: Model
    other: Model
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
