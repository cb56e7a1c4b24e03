"""The key `verify`: which runs have second runs, that tell what they are worth."""

import json
import warnings
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from geometry.base import Caution, Fault, Settings, SettingsError, merged, require

EVERY, PEAKS = "every", "peaks"
OLD = ("check", "twin", "halving")  # keys of 0.3.0


class Share(Settings):
    """Second runs where the risk is highest, within a share of the steps."""

    share: float = Field(
        default=0.1,
        ge=0,
        le=1,
        description="Share of the steps that second runs may take which bound the error of the "
        "step where the risk is highest; 0: none",
    )
    predictable: bool = Field(
        default=False,
        description="Run each speed again with all gaps changed by 1e-10 (its twin), to show which "
        "outputs can be predicted",
    )


def _one_of_the_forms(value: Any) -> Any:
    if isinstance(value, dict):
        return Share.model_validate(value)
    if isinstance(value, Share) or value in (EVERY, PEAKS):
        return value
    raise SettingsError(
        f"allowed are {PEAKS}, {EVERY}, or keys, as in `verify: {{share: 0.1}}`",
        value=value,
        allowed=[PEAKS, EVERY, *Share.model_fields],
    )


Verify = Annotated[Share | Literal["peaks", "every"], BeforeValidator(_one_of_the_forms)]


class FormerKeyWarning(Caution):
    """A key of an older version, which is read: the message says what to write now."""


def in_place_of_old(values: dict[str, Any]) -> dict[str, Any]:
    """Settings of a scene with `verify` in place of the keys of 0.3.0: check, twin, halving.

    With a warning that says what to write now.

    Raises
    ------
    SettingsError
        When another form of `verify` is given, too.
    """
    given = {key: values[key] for key in OLD if values.get(key) is not None}
    if not given:
        return values
    verify = values.get("verify", {})  # of a base, where this file has the old keys
    halving = given.get("halving", False)
    require(
        (
            isinstance(verify, dict),
            Fault(f"verify: {verify} is given, too: take this out", next(iter(given))),
        ),
        (halving in (True, False), Fault("should be true or false", "halving", halving)),
        kind=SettingsError,
    )
    now = {"check": "share", "twin": "predictable"}
    form = {now[key]: value for key, value in given.items() if key in now}
    form = EVERY if halving else form
    line = f"{', '.join(given)}: write `verify: {shown(form)}` instead"
    warnings.warn(line, FormerKeyWarning, stacklevel=2)
    others = {key: value for key, value in values.items() if key not in OLD}
    return others | {"verify": merged(verify, form)}


def shown(form: str | dict[str, Any]) -> str:
    """A form of `verify` as in a YAML file.

    >>> shown({"share": 0.2, "predictable": True})
    '{share: 0.2, predictable: true}'
    """
    return form if isinstance(form, str) else json.dumps(form).replace('"', "")
