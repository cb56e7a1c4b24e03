"""Reduced models that the study of accuracy and time compares: meshes, interface nodes, bases."""

from dataclasses import dataclass, replace

from geometry.blade import EnrichedBasis, PaperBasis

BASES = {  # those that no blade file has
    "small": EnrichedBasis(natural_modes=4, fixed_interface_modes=3),
    "paper": PaperBasis(kind="paper"),
}
RICH = ("reference-rich", "reference-finest")  # blades with the richer basis


@dataclass(frozen=True)
class Model:
    """A blade file on one of the bases, with its interface directions."""

    blade: str
    basis: str = "default"  # that of the blade file, or one of BASES
    directions: str = "r"

    @property
    def file(self) -> str:
        """Where it is."""
        if self.basis == "default":
            return f"results/{self.blade}/rom-{self.directions}.nc"
        return f"results/trade/models/{self.blade}-{self.basis}-{self.directions}.nc"

    def to(self, directions: str) -> "Model":
        """The same with these interface directions."""
        return replace(self, directions=directions)


REFERENCE = Model("reference")
FINEST = Model("reference-finest")
SIXTEEN = Model("reference-n16")
LINEAR = Model("reference-linear")  # stress of one linear static solve
BASIS_STUDY = (
    Model("reference", "paper"),
    Model("reference", "small"),
    REFERENCE,
    Model("reference-rich"),
)
NODES_STUDY = (Model("reference-n4"), REFERENCE, SIXTEEN)
MESH_STUDY = (Model("reference-coarse"), REFERENCE, Model("reference-fine"))
FRONT = (
    Model("reference-n4", "small"),
    Model("reference-n4"),
    Model("reference", "small"),
    REFERENCE,
    Model("reference-fine"),
    SIXTEEN,
    FINEST,
)


def all_models(least: str) -> list[Model]:
    """Every model of a scene that needs the interface directions ``least``."""
    wider = [directions for directions in ("r", "rt", "rtz") if len(directions) >= len(least)]
    once = dict.fromkeys((*BASIS_STUDY, *NODES_STUDY, *MESH_STUDY, *FRONT))
    return [m.to(least) for m in once] + [REFERENCE.to(d) for d in wider[1:]]
