"""Settings: YAML files of users, checked against pydantic models before anything runs."""

import warnings
from collections.abc import Callable, Iterator, Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import Any, ClassVar, Literal, Self, get_args

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    ValidationError,
    ValidationInfo,
    field_validator,
    model_validator,
)

from geometry.base.errors import Fault, SettingsError
from geometry.base.provenance import other_format
from geometry.base.strict_yaml import Keys
from geometry.base.units import FORMER, OTHER, converted
from geometry.base.yaml_file import Layer, merged, read_layers


def checked(check: Callable[[Any], None]) -> Any:
    """Decorator of a method of settings that raises a ValueError where their keys do not agree."""
    return model_validator(mode="after")(lambda settings: check(settings) or settings)


class Settings(BaseModel):
    """Base of every settings model: unknown keys are errors, values cannot change."""

    replaced: ClassVar[dict[str, str]] = {}  # keys of older versions, and their replacements
    hints: ClassVar[dict[str, str]] = {}  # hints for messages when the value of a key is refused
    either: ClassVar[Sequence[tuple[str, ...]]] = ()  # keys of which exactly one is given

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    def but(self, **changes: Any) -> Self:
        """A copy with other values, which is checked again.

        A nested key is named a__b, or given by a mapping, which changes only the keys it has, as a
        YAML file does with its `base`. Settings objects replace the former value entirely.

        Raises
        ------
        SettingsError
            When a key is unknown or the values are not valid together.
        """
        values = self.model_dump(exclude_unset=True)
        for key, value in changes.items():
            for name in reversed(key.split("__")):
                value = {name: value}
            values = merged(values, value)
        return check_settings(type(self), values, type(self).__name__.lower())

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read and check a YAML file, with the values of the file it names as its `base`.

        Raises
        ------
        geometry.base.errors.SettingsError
            When the file is missing, is no YAML mapping, or is not valid; the message has a line
            for each fault. A fault of its base as well is reported once, for the base.
        """
        layers = read_layers(path)
        with warnings.catch_warnings(record=True) as told:
            settings, faults = _checked(cls, layers[0].values)
        for each in told:  # with the file
            warnings.warn(f"{path}: {each.message}", each.category, stacklevel=2)
        if faults:
            raise SettingsError(*_with_files(cls, layers, faults))
        return settings

    @model_validator(mode="wrap")
    @classmethod
    def _faults_in_words_of_the_project(cls, values: Any, check: Callable[[Any], Self]) -> Self:
        """Describe the faults of this model by its own keys; settings around it add theirs.

        Values of former keys are read in the units of now.
        """
        try:
            return check(_as_now(cls, values))
        except ValidationError as error:
            raise SettingsError(*_faults(cls, error)) from None

    @checked
    def _exactly_one_of_each(self) -> None:
        for keys in self.either:
            given = [key for key in keys if getattr(self, key) is not None]
            if len(given) != 1:
                named = " and ".join(given) or "none"
                raise SettingsError(
                    f"give exactly one of {', '.join(keys)}; found {named}", allowed=keys
                )

    @field_validator("*", mode="before")
    @classmethod
    def _no_boolean_for_a_number(cls, value: Any, info: ValidationInfo) -> Any:
        """Refuse booleans of YAML (true, yes, on), which pydantic would read as 1."""
        if _holds_boolean(value) and cls.model_fields[info.field_name].annotation is not bool:
            raise SettingsError(
                "true, yes, on, false, no, off are booleans: give a number, or a name in quotes",
                value=value,
            )
        return value


class SettingsFile(Settings):
    """Base of settings with a file of their own; the default of ``format`` is the one accepted."""

    format: Literal[1] = Field(
        default=1, description="Format of the file; files of another one are refused"
    )

    @model_validator(mode="before")
    @classmethod
    def _of_this_format(cls, values: Any) -> Any:
        """Check the format before the keys, which differ between formats."""
        given = values.get("format") if isinstance(values, dict) else None
        read = cls.model_fields["format"].default
        if type(given) in (int, float) and given != read:
            raise SettingsError(
                other_format(given, read, "CHANGELOG.md says what has changed"),
                key="format",
                value=given,
                allowed=read,
            )
        return values


def known[T](value: T | None, key: str) -> T:
    """``value`` of an optional key, where a check or an earlier stage has seen that there is one.

    Raises
    ------
    SettingsError
        When there is none.
    """
    if value is None:
        raise SettingsError("is not given, nor chosen yet", key=key)
    return value


def _as_now(model: type[Settings], values: Any) -> Any:
    """``values`` with the keys of ``model`` for former ones in other units.

    Raises
    ------
    SettingsError
        When one is given in both units.
    """
    if not isinstance(values, dict):
        return values
    fields = model.model_fields
    # keys that are gone change nothing where they are off, as in results of 0.3.0
    read = {key: value for key, value in values.items() if key not in model.replaced or value}
    for key in values.keys() & FORMER.keys() - fields.keys():
        former = FORMER[key]
        if values[key] is not None and values.get(former.now) is not None:
            raise SettingsError(f"is given as {former.now}, too", key=key)
        if former.now in fields:
            value = read.pop(key)
            read |= {} if value is None else {former.now: converted(value, former.to_now)}
    return read


def _holds_boolean(value: Any) -> bool:
    return isinstance(value, bool) or (
        isinstance(value, list | tuple) and any(_holds_boolean(item) for item in value)
    )


def one_of(
    name: str, key: str, *models: type[Settings], default: str | None = None
) -> BeforeValidator:
    """Choose one model of a union by their literal field ``key``.

    Faults are reported for the chosen model only. ``name``: key of the user that holds the union;
    ``default``: value of ``key`` where it is not given.

    Raises
    ------
    ValueError
        When two models have the same value of ``key``.
    """
    tags = [get_args(model.model_fields[key].annotation)[0] for model in models]
    if twice := {tag for tag in tags if tags.count(tag) > 1}:
        raise ValueError(f"{name}: more than one model has {key}: {', '.join(sorted(twice))}")
    choices = " or ".join(f"{key}: {tag}" + " (the default)" * (tag == default) for tag in tags)
    tag, model = next(pair for pair in zip(tags, models, strict=True) if pair[0] != default)
    fields = model.model_fields.items()
    others = [f"{of}: ..." for of, field in fields if field.is_required() and of != key]
    example = f"{name}: {{{', '.join([f'{key}: {tag}', *others])}}}"

    def chosen(value: Any) -> Any:
        """Settings of the model that ``value`` names; other models are not tried."""
        if isinstance(value, models):
            return value
        if not isinstance(value, dict):
            raise SettingsError(
                f"needs keys, among them {choices}, as in `{example}`", value=value, allowed=tags
            )
        tag = value.get(key, default)
        if tag not in tags:
            raise SettingsError(
                f"{'' if tag else 'missing; '}should be {_listed(tags)}",
                key=key,
                value=tag,
                allowed=tags,
            )
        return models[tags.index(tag)].model_validate(value | {key: tag})

    return BeforeValidator(chosen)


def _listed(choices: Sequence[str]) -> str:
    """List of choices as in messages of pydantic: 'a', 'b' or 'c'."""
    *others, last = map(repr, choices)
    return f"{', '.join(others)} or {last}"


NO_BOUNDS = ("error", "field_type", "actual_length", "class_name")  # of pydantic's context
MESSAGES = {  # that replace those of pydantic, by its name of the fault
    "missing": "missing and required",
    "bool_parsing": "should be true or false",
    "bool_type": "should be true or false",
}


def check_settings[Model: Settings](
    model: type[Model], values: dict[str, Any], source: str
) -> Model:
    """Check ``values`` against ``model``; ``source`` names their file in messages.

    Raises
    ------
    SettingsError
        When they are not valid; the message has a line for each fault.
    """
    settings, faults = _checked(model, values)
    if faults:
        raise SettingsError(*faults).within(source)
    return settings


def _checked(model: type[Settings], values: dict[str, Any]) -> tuple[Any, list[Fault]]:
    """Settings of ``values``, or None with their faults, each once."""
    try:
        return model.model_validate(values), []
    except ValidationError as error:
        return None, list({str(fault): fault for fault in _faults(model, error)}.values())


def _with_files(
    model: type[Settings], layers: Sequence[Layer], faults: Sequence[Fault]
) -> Iterator[Fault]:
    """``faults`` of the first of ``layers``, each with the file of the lowest base that has it."""
    in_bases = [set(map(str, _checked(model, base.values)[1])) for base in layers[1:]]
    for fault in faults:
        below = zip(layers, [*in_bases, set()], strict=True)
        layer = next(layer for layer, base_faults in below if str(fault) not in base_faults)
        yield fault._replace(
            file=layer.source, line=_line(layer.lines, tuple(fault.key.split(".")))
        )


def _line(lines: dict[Keys, int], keys: Keys) -> int | None:
    """The line of a key, in either unit, or of the innermost mapping around it in the file."""
    around = (keys[:count] for count in range(len(keys), 0, -1))
    either = (part for key in around for part in (key, (*key[:-1], OTHER.get(key[-1], ""))))
    return next((lines[part] for part in either if part in lines), None)


def _faults(model: type[Settings], error: ValidationError) -> Iterator[Fault]:
    """Faults that pydantic finds in a model, without missing keys that were given, but misspelt."""
    errors = error.errors()
    unknown = [fault["loc"][0] for fault in errors if fault["type"] == "extra_forbidden"]
    misspelt = {near for key in unknown for near in _nearest(model, key)}
    for fault in errors:
        if fault["type"] != "missing" or fault["loc"][0] not in misspelt:
            yield from _described(model, fault)


def _described(model: type[Settings], fault: Any) -> Sequence[Fault]:
    """A fault of pydantic with the words of this project; those of a nested model have them."""
    kind, cause = fault["type"], fault.get("ctx", {}).get("error")
    first, *others = fault["loc"] or ("",)
    # other texts in a location name a branch of a union
    key = ".".join(map(str, [first, *(part for part in others if isinstance(part, int))]))
    if isinstance(cause, SettingsError):
        return cause.within(key=key).faults
    if kind == "extra_forbidden":
        return [_unknown(model, key)]
    messages = MESSAGES | {"model_type": f"needs keys: {', '.join(_keys(model))}"}
    text = messages.get(kind, fault["msg"].replace("Input should", "should"))
    if kind in ("missing", "value_error"):
        return [Fault(text.removeprefix("Value error, "), key)]
    hints = [model.hints[first]] if first in model.hints else []
    allowed = {name: bound for name, bound in fault.get("ctx", {}).items() if name not in NO_BOUNDS}
    return [Fault("; ".join([text, *hints]), key, fault["input"], allowed or None)]


def _unknown(model: type[Settings], key: str) -> Fault:
    """The fault of a key that the model does not have, or no longer."""
    if key in model.replaced:
        return Fault(f"no longer a key; {model.replaced[key]}", key)
    near, keys = _nearest(model, key), _keys(model)
    hint = f"did you mean '{near[0]}'?" if near else f"known keys: {', '.join(keys)}"
    return Fault(f"unknown key; {hint}", key, allowed=near or keys)


def _nearest(model: type[Settings], key: str) -> list[str]:
    """The key of the model closest to an unknown one, as a list of one or none."""
    return get_close_matches(key, _keys(model), n=1)


def _keys(model: type[Settings]) -> list[str]:
    """The keys of a model as users write them: one that is a word of Python has an alias."""
    return [field.alias or name for name, field in model.model_fields.items()]
