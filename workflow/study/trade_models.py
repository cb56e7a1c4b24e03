"""Reduced models that the study of accuracy and time compares: meshes, patches, bases."""

from dataclasses import dataclass, replace

from geometry.blade import EnrichedBasis

BASES = {  # those that no blade file has, by their natural modes
    "12-modes": EnrichedBasis(natural_modes=12),
    "18-modes": EnrichedBasis(natural_modes=18),
}


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
EIGHT, TWICE = Model("reference-n8"), Model("reference-n32")  # half and twice the patches
LINEAR = Model("reference-linear")  # stress of one linear static solve
PAPER = Model("reference-paper")  # eight points, the paper's basis
BASIS_STUDY = (
    Model("reference", "12-modes"),
    Model("reference", "18-modes"),
    REFERENCE,
    Model("reference-rich"),
)
MESH_STUDY = (Model("reference-coarse"), REFERENCE, Model("reference-fine"))


def all_models(least: str) -> list[Model]:
    """Every model of a scene that needs the interface directions ``least``."""
    once = dict.fromkeys((*BASIS_STUDY, EIGHT, TWICE, PAPER, *MESH_STUDY, FINEST))
    return [m.to(least) for m in once]
