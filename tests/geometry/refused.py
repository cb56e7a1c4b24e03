"""The error by which a call refuses what it is given."""

from collections.abc import Callable
from typing import Any

import pytest


def refused[Kind: Exception](
    kind: type[Kind], call: Callable[..., Any], *args: Any, match: str | None = None, **keys: Any
) -> Kind:
    """The error of this kind, in one line, that ``call`` raises with the arguments given."""
    with pytest.raises(kind, match=match) as caught:
        call(*args, **keys)
    assert "\n" not in str(caught.value), str(caught.value)
    return caught.value
