"""Cards of an Abaqus or CalculiX deck, to which decks of Nastran are translated too."""

import re
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

from geometry.base import read_text, require

# a row with options: one that has a value, or first one that has none
OPTION = re.compile(r".*=|(GENERATE|INTERNAL|UNSORTED)\s*(,|$)", re.IGNORECASE)


@dataclass
class Card:
    """A card of a deck, with its options and its rows."""

    keyword: str
    options: dict[str, str]
    line: int
    rows: list[tuple[int, list[str]]] = field(default_factory=list)  # with their lines

    def option(self, name: str) -> str:
        """An option without which the card says nothing."""
        require((self.options.get(name), f"*{self.keyword} has no {name}"), line=self.line)
        return self.options[name]


def read_cards(path: Path) -> list[Card]:
    """All cards, the first with the rows before them.

    Of CalculiX also those that end with a comma, which Abaqus takes for "goes on".
    """
    cards = [Card("", {}, 0)]
    lines = enumerate(map(str.strip, read_text(path, most=None, errors="replace").splitlines()), 1)
    read = ((place, line) for place, line in lines if line and not line.startswith("**"))
    for (_, before), (place, line) in pairwise([(0, ""), *read]):
        if line.startswith("*"):
            keyword, _, options = line.lstrip("*").partition(",")
            cards.append(Card(keyword.strip().upper(), _options(options), place))
        elif before.endswith(",") and not cards[-1].rows and OPTION.match(line):
            cards[-1].options |= _options(line)
        else:
            cards[-1].rows.append((place, [value.strip() for value in line.split(",")]))
    return cards


def _options(text: str) -> dict[str, str]:
    pairs = (option.partition("=") for option in text.upper().split(","))
    return {name.strip(): value.strip().strip('"') for name, _, value in pairs}
