"""Units of what users write: one for each quantity, named in the key, in all files.

mm for parts, um for gaps and motions, rpm for speeds, GPa for stiffness, MPa for stress and moduli
of liners, deg for angles. Inside, and in files of results, all is SI. ``FORMER`` has the keys of
0.3.0 in other units, which are still read.
"""

from collections.abc import Callable
from contextlib import suppress
from decimal import Decimal
from functools import partial
from math import inf, nextafter, pi
from typing import Any, NamedTuple

RPM = 30 / pi  # of 1 rad/s


def shifted(value: float, power: int) -> float:
    """``value`` times ten to a power, exact in its decimals: lengths in m and mm are the same bits.

    >>> shifted(2.48, -3), shifted(0.00248, 3), 2.48e-6 * 1e6 == 2.48
    (0.00248, 2.48, True)
    """
    return float(Decimal(repr(float(value))).scaleb(power))


def in_rpm(rad_s: float) -> float:
    """A speed in rpm that is ``rad_s`` again over ``RPM``."""
    rpm = rad_s * RPM
    near = (rpm, nextafter(rpm, inf), nextafter(rpm, -inf))
    return next((value for value in near if value / RPM == rad_s), rpm)


class Former(NamedTuple):
    """A key of 0.3.0, or another spelling: its key now, the number in its unit, and back."""

    now: str
    to_now: Callable[[float], float]
    back: Callable[[float], float]


def _ten(now: str, power: int) -> Former:
    """A unit that is ten to ``power`` of that of now."""
    return Former(now, partial(shifted, power=power), partial(shifted, power=-power))


FORMER = {
    **{f"{edge}_edge_m": _ten(f"{edge}_edge_um", 6) for edge in ("leading", "trailing")},
    **{
        f"{name}_m": _ten(f"{name}_um", 6) for name in ("amplitude", "depth", "growth", "edge_drop")
    },
    **{f"{name}_m": _ten(f"{name}_mm", 3) for name in ("thickness", "footprint", "hub_radius")},
    **{f"{name}_Pa": _ten(f"{name}_MPa", -6) for name in ("unit", "stress")},
    **{
        f"{name}rad_s": Former(f"{name}rpm", in_rpm, lambda rpm: rpm / RPM)
        for name in ("", "speed_", "max_speed_")
    },
    "frequencies_hz": Former("frequencies_Hz", float, float),
}
# each key by the other one of the same quantity
OTHER = {
    **{key: former.now for key, former in FORMER.items()},
    **{former.now: key for key, former in FORMER.items()},
}


def converted(value: Any, convert: Callable[[float], float]) -> Any:
    """All numbers of a value of a key: also as texts, of a list, of a range by its ends.

    What is no number stays, for the settings to refuse.
    """
    if isinstance(value, dict) or hasattr(value, "model_fields"):
        return {k: v if k == "count" else converted(v, convert) for k, v in dict(value).items()}
    if isinstance(value, list | tuple | range):
        return [converted(item, convert) for item in value]
    if hasattr(value, "tolist"):  # of NumPy
        return converted(value.tolist(), convert)
    with suppress(TypeError, ValueError, OverflowError):
        return value if isinstance(value, bool) else convert(float(value))
    return value


def as_in(base: dict[str, Any], values: dict[str, Any]) -> dict[str, Any]:
    """``base`` with a quantity under the key of ``values``, in its unit, where these have another.

    >>> as_in({"rpm": {"first": 600, "count": 2}}, {"rad_s": {"first": 100}})
    {'rad_s': {'first': 62.83185307179586, 'count': 2}}
    """
    read = {}
    for key, value in base.items():
        other = OTHER.get(key)
        if other in values and key not in values and other not in base:
            convert = FORMER[other].back if other in FORMER else FORMER[key].to_now
            key, value = other, converted(value, convert)
        read[key] = value
    return read
