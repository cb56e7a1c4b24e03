"""Which settings the study of accuracy and time marches, and what each is compared with."""

from dataclasses import dataclass

from simulate.scene import STRIPS
from workflow.study.trade_models import (
    BASIS_STUDY,
    EIGHT,
    FINEST,
    MESH_STUDY,
    PAPER,
    REFERENCE,
    TWICE,
    Model,
)
from workflow.study.trade_runs import Setting, exact

# Scene file and speed over f1(0): away from peaks, on one, a stiffer liner, a tilted tip.
SCENES = {
    "calm": ("paper-e1", 0.38),
    "resonance": ("paper-e1", 0.346),
    "stiff": ("paper-e10", 0.38),
    "tangential": ("paper-tangential", 0.31),
}
# Models with numbers of strips: those compared, the last as fine as any, and those of the front.
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
FRACTIONS = (0.8, 0.4, 0.2)  # of the limit with contact
SCALED_HZ, SCALED_FRACTIONS = 25e3, (0.8, 0.4, 0.2)
FRONT_STEPS = STEPS[:4]
SAME, OVERALL, LAST = "same model", "finest", "finest of the choice"


@dataclass(frozen=True)
class Tip:
    """Rods per round and fine steps; primes, so that steps do not meet every rod alike."""

    studied: tuple[int, ...]
    own: int  # of the studies of other choices than rods
    tiers: tuple[int, ...]  # of the front: few, some, many
    fine: int  # of the studies of the model
    finest: int
    fine_steps: int
    finest_steps: int


FLAT = Tip(
    studied=(509, 1021, 2039, 4093, 8191),
    own=2039,
    tiers=(1021, 2039, 4093),
    fine=8191,
    finest=16381,
    fine_steps=2**16,
    finest_steps=2**17,
)
# It bears on a fiftieth of its length: as many more rods. Steps of a power of two meet 131071 rods
# all alike, 1.2 % off what 1 % more or fewer of them give; these are far from every p/q of a step.
TILTED = Tip(
    studied=(38543, 77101, 153911, 308411, 615709),
    own=153911,
    tiers=(153911, 308411, 615709),
    fine=308411,
    finest=1233619,
    fine_steps=2**14,  # steps matter less here than rods
    finest_steps=2**15,
)


@dataclass(frozen=True)
class Compared:
    """A setting of one study, and what its errors are of."""

    study: str
    label: str
    setting: Setting
    against: Setting
    of: str  # SAME, OVERALL or LAST


def tip_of(scene: str) -> Tip:
    """Rods and fine steps of a scene."""
    return TILTED if scene == "tangential" else FLAT


def least_of(scene: str) -> str:
    """Interface directions that it needs."""
    return "rt" if scene == "tangential" else "r"


def finest(scene: str) -> Setting:
    """What is taken as true: twice the patches and strips, half as many modes more."""
    tip = tip_of(scene)
    return exact(FINEST.to(least_of(scene)), tip.finest_steps, tip.finest, 2 * FINE_STRIPS)


def coarser(scene: str) -> Setting:
    """One level coarser than ``finest`` in everything."""
    tip = tip_of(scene)
    rods = tip.studied[-1]
    return exact(REFERENCE.to(least_of(scene)), tip.finest_steps // 2, rods, FINE_STRIPS)


def compared(scene: str) -> list[Compared]:
    """All settings of all studies on a scene."""
    return [
        *_schemes(scene),
        *_rods(scene),
        *_alone(scene, "modes", BASIS_STUDY),
        *_interfaces(scene),
        *_alone(scene, "mesh", MESH_STUDY),
        *front(scene),
    ]


def other_scheme(scene: str) -> str:
    """Label of the run that tells what another scheme changes."""
    return f"central-difference, {FRACTIONS[-1]:g} of the limit"


def _schemes(scene: str) -> list[Compared]:
    tip, model = tip_of(scene), REFERENCE.to(least_of(scene))
    fine = exact(model, 2 * STEPS[-1], tip.own)
    central = "central-difference"
    settings = {f"{steps} steps": exact(model, steps, tip.own) for steps in STEPS}
    settings |= {
        f"{central}, {part:g} of the limit": Setting(model, central, part, tip.own, STRIPS)
        for part in FRACTIONS
    }
    settings |= {
        f"mass-scaled, {part:g} of the limit": Setting(
            model, central, part, tip.own, STRIPS, SCALED_HZ
        )
        for part in SCALED_FRACTIONS
    }
    return [Compared("scheme", label, s, fine, SAME) for label, s in settings.items()]


def _rods(scene: str) -> list[Compared]:
    tip, model = tip_of(scene), REFERENCE.to(least_of(scene))
    steps = tip.fine_steps // 2
    fine = exact(model, steps, tip.finest)
    return [
        Compared("rods", f"{rods} rods", exact(model, steps, rods), fine, SAME)
        for rods in tip.studied
    ]


def _interfaces(scene: str) -> list[Compared]:
    """Patches and strips at the steps and rods of the studies of the model, against twice both."""
    tip, least = tip_of(scene), least_of(scene)
    *others, last = [
        (label, exact(model.to(least), tip.fine_steps, tip.fine, strips))
        for label, model, strips in INTERFACES
    ]
    return [Compared("interface", label, setting, last[1], LAST) for label, setting in others]


def _alone(scene: str, study: str, models: tuple[Model, ...]) -> list[Compared]:
    """What one choice changes where all else stays: against the last of the models."""
    tip, least = tip_of(scene), least_of(scene)
    *others, last = [exact(m.to(least), tip.fine_steps, tip.fine) for m in models]
    return [Compared(study, name(s.model), s, last, LAST) for s in others]


def front(scene: str) -> list[Compared]:
    """Combinations; a label says the same on every scene."""
    tip, true = tip_of(scene), finest(scene)
    return [
        Compared(
            "front",
            f"{name(m)}, {strips} strips, {steps} steps, {tier} rods",
            exact(m.to(least_of(scene)), steps, rods, strips),
            true,
            OVERALL,
        )
        for m, strips in FRONT
        for steps in FRONT_STEPS
        for tier, rods in zip(("few", "some", "many"), tip.tiers, strict=True)
    ]


def name(model: Model) -> str:
    """A model's name in a label."""
    return model.blade + ("" if model.basis == "default" else f" with basis {model.basis}")
