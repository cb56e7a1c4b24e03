"""Cases of the verification page: numbers of other programs or closed forms beside ours."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import NamedTuple


class Row(NamedTuple):
    """One number of another source, ours, and the largest difference that is allowed."""

    quantity: str  # with its unit
    theirs: float | None  # None where there is ours alone, which then has no difference
    ours: float
    tolerance: float  # of the difference
    scale: float | None = None  # differences are over it, else over their number

    @property
    def difference(self) -> float:
        """Ours less theirs, over the scale."""
        if self.theirs is None:
            return 0.0
        return (self.ours - self.theirs) / (abs(self.theirs) if self.scale is None else self.scale)

    @property
    def share(self) -> float:
        """Size of the difference over its tolerance."""
        return abs(self.difference) / self.tolerance

    @property
    def shown(self) -> str:
        """Difference, with its sign."""
        return "" if self.theirs is None else f"{self.difference:+.1e}"

    @property
    def digits(self) -> tuple[str, str]:
        """Both numbers."""
        return "" if self.theirs is None else f"{self.theirs:.8g}", f"{self.ours:.8g}"


@dataclass(frozen=True)
class Case:
    """A comparison with one source."""

    title: str
    source: str  # of their numbers
    compared: str  # problem, and how it was computed here
    reason: str  # of the tolerances
    rows: Callable[[], Iterable[Row]]
    conclusion: str = ""  # Markdown below the table
    by: str = "theirs"  # head of their numbers
    study: bool = False  # a second method or model of this project, not a source outside
    nightly: bool = False  # takes long: computed by night and for the page
