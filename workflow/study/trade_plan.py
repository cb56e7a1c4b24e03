"""Plan of the study of accuracy and time: models, scenes, settings, and what is compared."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from simulate.scene import STRIPS


@dataclass(frozen=True)
class Model:
    """The reduced model of a blade file, with its interface directions."""

    blade: str
    modes: int | None = None  # natural modes; None: those of the blade file
    directions: str = "r"

    @property
    def file(self) -> str:
        """Path of its file."""
        if self.modes is None:
            return f"results/{self.blade}/rom-{self.directions}.nc"
        return f"results/trade/models/{self.blade}-{self.modes}-modes-{self.directions}.nc"

    def to(self, directions: str) -> "Model":
        """The model with other interface directions."""
        return replace(self, directions=directions)


REFERENCE = Model("reference")
FINEST = Model("reference-finest")
EIGHT, TWICE = Model("reference-n8"), Model("reference-n32")  # half and twice the patches
LINEAR = Model("reference-linear")  # stress of one linear static solve
PAPER = Model("reference-paper")  # eight points, the paper's basis
BASIS_STUDY = (
    Model("reference", modes=12),
    Model("reference", modes=18),
    REFERENCE,
    Model("reference-rich"),
)
MESH_STUDY = (Model("reference-coarse"), REFERENCE, Model("reference-fine"))
MODELS = tuple(dict.fromkeys((*BASIS_STUDY, EIGHT, TWICE, PAPER, *MESH_STUDY, FINEST)))

# Models with numbers of strips: those compared, the last the finest, and those of the front.
FINE_STRIPS = 32
INTERFACES = (
    ("8 points, the paper's", PAPER, 8),
    ("8 patches, 8 strips", EIGHT, 8),
    ("8 patches, 16 strips", EIGHT, 16),
    ("16 patches, 16 strips", REFERENCE, 16),
    ("8 patches, 32 strips", EIGHT, 32),
    ("16 patches, 32 strips", REFERENCE, 32),
    ("32 patches, 64 strips", TWICE, 64),
)
FRONT = ((EIGHT, 8), (EIGHT, 16), (REFERENCE, 16), (REFERENCE, 32))
STEPS = tuple(1024 * 2**k for k in range(7))  # per round
CENTRAL, FRACTIONS = "central-difference", (0.8, 0.4, 0.2)  # of the limit with contact
# Label of the run that gives the difference made by another scheme.
OTHER_SCHEME = f"{CENTRAL}, {FRACTIONS[-1]:g} of the limit"
SCALED_HZ = 25e3
FRONT_STEPS = STEPS[:4]
FINE_STEPS, FINEST_STEPS = 2**14, 2**15  # of all tips: with a tilted one rods matter more
SAME, OVERALL, LAST = "same model", "finest", "finest of the choice"


@dataclass(frozen=True)
class Tip:
    """Rods per round."""

    studied: tuple[int, ...]
    own: int  # of the studies of choices other than rods
    tiers: tuple[int, ...]  # of the front: few, some, many
    fine: int  # of the studies of the model
    finest: int


FLAT = Tip(
    studied=(509, 1021, 2039, 4093, 8191),
    own=2039,
    tiers=(1021, 2039, 4093),
    fine=8191,
    finest=16381,
)
# A tilted tip is in contact over a fiftieth of its footprint: it needs 50 times the rods. 131071
# rods are nearly commensurate with steps of a power of two: results are 1.2 % off those of 1 % more
# or fewer rods. The rods per step of the numbers below are far from every small ratio p/q.
TILTED = Tip(
    studied=(38543, 77101, 153911, 308411, 615709),
    own=153911,
    tiers=(153911, 308411, 615709),
    fine=308411,
    finest=1233619,
)


class Studied(NamedTuple):
    """A scene at one speed."""

    file: str
    speed: float  # over f1(0)
    swept: bool = False  # whether its peak is computed as well
    tip: Tip = FLAT
    directions: str = "r"  # of the interface


SCENES = {  # away from a peak, at a peak, with a stiffer liner, with a tilted tip
    "calm": Studied("hand-e1", 0.38),
    "resonance": Studied("hand-e1", 0.346, swept=True),
    "stiff": Studied("hand-e10", 0.38),
    "tangential": Studied("hand-tangential", 0.31, tip=TILTED, directions="rt"),
}


@dataclass(frozen=True)
class Setting:
    """Settings of a run: model, scheme and step, rods, strips."""

    model: Model
    scheme: str
    step: float  # steps per round, or fraction of the limit of central differences
    rods: int
    strips: int
    mass_scaling_hz: float | None = None

    @property
    def integrator(self) -> dict[str, Any]:
        """Settings of the integrator of a scene."""
        key = "fraction_of_limit" if self.scheme == CENTRAL else "steps_per_round"
        return {"scheme": self.scheme, key: self.step, "mass_scaling_hz": self.mass_scaling_hz}


def exact(model: Model, steps: int, rods: int, strips: int = STRIPS) -> Setting:
    """Setting with the scheme piecewise-exact."""
    return Setting(model, "piecewise-exact", steps, rods, strips)


@dataclass(frozen=True)
class Compared:
    """A setting of one study, and the reference that it is compared with."""

    study: str
    label: str  # {modes} and {mesh_mm} are replaced by those of its model
    setting: Setting
    against: Setting
    of: str  # kind of reference: SAME, OVERALL or LAST


def finest(scene: Studied) -> Setting:
    """The overall reference: twice the patches and strips, 1.5 times the modes."""
    model, rods = FINEST.to(scene.directions), scene.tip.finest
    return exact(model, FINEST_STEPS, rods, 2 * FINE_STRIPS)


def coarser(scene: Studied) -> Setting:
    """One level coarser than ``finest`` in everything."""
    steps, rods = FINEST_STEPS // 2, scene.tip.studied[-1]
    return exact(REFERENCE.to(scene.directions), steps, rods, FINE_STRIPS)


def compared(scene: Studied) -> list[Compared]:
    """All settings of all studies on a scene."""
    return [
        *_schemes(scene),
        *_rods(scene),
        *_alone(scene, "modes", [("{modes} modes", m, STRIPS) for m in BASIS_STUDY]),
        *_alone(scene, "interface", INTERFACES),
        *_alone(scene, "mesh", [("{mesh_mm:g} mm", m, STRIPS) for m in MESH_STUDY]),
        *front(scene),
    ]


def _schemes(scene: Studied) -> list[Compared]:
    model, rods = REFERENCE.to(scene.directions), scene.tip.own
    fine = exact(model, 2 * STEPS[-1], rods)
    settings = {f"{steps} steps": exact(model, steps, rods) for steps in STEPS}
    settings |= {
        f"{name}, {part:g} of the limit": Setting(model, CENTRAL, part, rods, STRIPS, scaled_hz)
        for name, scaled_hz in ((CENTRAL, None), ("mass-scaled", SCALED_HZ))
        for part in FRACTIONS
    }
    return [Compared("scheme", label, s, fine, SAME) for label, s in settings.items()]


def _rods(scene: Studied) -> list[Compared]:
    tip, model = scene.tip, REFERENCE.to(scene.directions)
    steps = FINE_STEPS // 2
    fine = exact(model, steps, tip.finest)
    return [
        Compared("rods", f"{rods} rods", exact(model, steps, rods), fine, SAME)
        for rods in tip.studied
    ]


def _alone(scene: Studied, study: str, models: Iterable[tuple[str, Model, int]]) -> list[Compared]:
    """Variations of one choice of the model alone, compared with the last of them.

    ``models``: labels, models and strips.
    """
    *others, (_, last) = [
        (label, exact(model.to(scene.directions), FINE_STEPS, scene.tip.fine, strips))
        for label, model, strips in models
    ]
    return [Compared(study, label, setting, last, LAST) for label, setting in others]


def front(scene: Studied) -> list[Compared]:
    """Combinations of settings, compared with ``finest``; labels are the same for all scenes."""
    tip, true = scene.tip, finest(scene)
    return [
        Compared(
            "front",
            f"{model.blade}, {strips} strips, {steps} steps, {tier} rods",
            exact(model.to(scene.directions), steps, rods, strips),
            true,
            OVERALL,
        )
        for model, strips in FRONT
        for steps in FRONT_STEPS
        for tier, rods in zip(("few", "some", "many"), tip.tiers, strict=True)
    ]
