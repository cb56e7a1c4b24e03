"""Settings: YAML files of users, checked against pydantic models before anything runs."""

from collections.abc import Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, Self, Union, get_args

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    ValidationError,
    ValidationInfo,
    field_validator,
    model_validator,
)

from geometry.project.errors import Fault, SettingsError
from geometry.project.strict_yaml import Keys
from geometry.project.version import other_format
from geometry.project.yaml_file import Layer, merged, read_layers


class Settings(BaseModel):
    """Base of every settings model: unknown keys are errors, values cannot change."""

    replaced: ClassVar[dict[str, str]] = {}  # keys of older versions, and what replaces them
    hints: ClassVar[dict[str, str]] = {}  # hints for messages when the value of a key is refused

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

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read and check a settings file.

        Raises
        ------
        geometry.project.errors.SettingsError
            When it is not valid; the message has a line for each fault.
        """
        return read_settings(cls, path)

    @model_validator(mode="before")
    @classmethod
    def _of_this_format(cls, values: Any) -> Any:
        """Check the format before the keys, which differ between formats."""
        found = values.get("format") if isinstance(values, dict) else None
        read = cls.model_fields["format"].default
        if type(found) in (int, float) and found != read:
            raise SettingsError(
                other_format(found, read, "CHANGELOG.md says what has changed"),
                key="format",
                value=found,
                allowed=read,
            )
        return values


def _holds_boolean(value: Any) -> bool:
    return isinstance(value, bool) or (
        isinstance(value, list | tuple) and any(_holds_boolean(item) for item in value)
    )


def one_of(name: str, key: str, *models: type[Settings], default: str | None = None) -> Any:
    """Union of models, discriminated by their literal field ``key``.

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
    example = f"{name}: {{{', '.join([f'{key}: {tag}', *_required(model, key)])}}}"

    def chosen(value: Any) -> Any:
        """``value`` with its key, checked before pydantic chooses the model."""
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
        return value | {key: tag}

    def branch(value: Any) -> str:
        return value[key] if isinstance(value, dict) else getattr(value, key)

    tagged = tuple(Annotated[model, Tag(tag)] for tag, model in zip(tags, models, strict=True))
    return Annotated[Union[tagged], Discriminator(branch), BeforeValidator(chosen)]  # noqa: UP007


def _required(model: type[Settings], but: str) -> list[str]:
    fields = model.model_fields.items()
    return [f"{key}: ..." for key, field in fields if field.is_required() and key != but]


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


def read_settings[Model: BaseModel](model: type[Model], path: str | Path) -> Model:
    """Read and check a YAML file, with the values of the file it names as its `base`.

    Raises
    ------
    SettingsError
        When the file is missing, is no YAML mapping, or is not valid for ``model``. A fault that
        its base has as well is told of the base.
    """
    layers = read_layers(path)
    found, faults = _checked(model, layers[0].values)
    if faults:
        raise SettingsError(*_of_layers(model, layers, faults))
    return found


def check_settings[Model: BaseModel](
    model: type[Model], values: dict[str, Any], source: str
) -> Model:
    """Check ``values`` against ``model``; ``source`` names their file in messages.

    Raises
    ------
    SettingsError
        When they are not valid; the message has a line for each fault.
    """
    found, faults = _checked(model, values)
    if faults:
        raise SettingsError(*faults).within(source)
    return found


def _checked(model: type[BaseModel], values: dict[str, Any]) -> tuple[Any, list[Fault]]:
    """Settings of ``values``, or None with their faults, each once."""
    try:
        return model.model_validate(values), []
    except ValidationError as error:
        causes = _causes(model, error.errors())
    faults = [fault for cause in causes for fault in _described(model, cause)]
    return None, list({str(fault): fault for fault in faults}.values())


def _of_layers(
    model: type[BaseModel], layers: Sequence[Layer], faults: Sequence[Fault]
) -> list[Fault]:
    """``faults`` of the first of ``layers``, each with the file of the lowest base that has it."""
    owners = dict.fromkeys(map(str, faults), layers[0])
    for base in layers[1:]:
        in_base = set(map(str, _checked(model, base.values)[1]))
        above = layers[layers.index(base) - 1]
        owners |= {f: base for f, owner in owners.items() if owner is above and f in in_base}
    return [
        fault._replace(file=of.source, line=_line(of.lines, tuple(fault.key.split("."))))
        for fault, of in zip(faults, owners.values(), strict=True)
    ]


def _line(lines: dict[Keys, int], keys: Keys) -> int | None:
    """The line of a key, or of the innermost mapping around it that the file has."""
    around = (keys[:count] for count in range(len(keys), 0, -1))
    return next((lines[part] for part in around if part in lines), None)


def _causes(model: type[BaseModel], faults: Sequence[Any]) -> list[Any]:
    """Faults without missing keys that were given, but misspelt."""
    misspelt = {
        (*fault["loc"][:-1], meant)
        for fault in faults
        if fault["type"] == "extra_forbidden"
        for meant in _nearest(model, fault["loc"])
    }
    return [f for f in faults if f["type"] != "missing" or f["loc"] not in misspelt]


def _described(model: type[BaseModel], fault: Any) -> Sequence[Fault]:
    """A fault of pydantic with the keys of the file and the words of this project."""
    *parents, last = fault["loc"] or ("",)
    context = fault.get("ctx", {})
    if isinstance(context.get("error"), SettingsError):
        return context["error"].within(key=".".join(_walk(model, fault["loc"])[0])).faults
    if fault["type"] == "extra_forbidden":
        keys, models = _walk(model, parents)
        key = ".".join([*keys, str(last)])
        for instead in (m.replaced[last] for m in models if last in m.replaced):
            return [Fault(f"no longer a key; {instead}", key)]
        near, known = _nearest(model, fault["loc"]), _allowed_keys(model, parents)
        hint = f"did you mean '{near[0]}'?" if near else f"known keys: {', '.join(known)}"
        return [Fault(f"unknown key; {hint}", key, allowed=near or known)]
    key, message = ".".join(_walk(model, fault["loc"])[0]), _message(model, fault)
    if fault["type"] in ("missing", "value_error"):
        return [Fault(message, key)]
    text = "; ".join([message, *_hints(model, fault["loc"])])
    allowed = {name: bound for name, bound in context.items() if name not in NO_BOUNDS}
    return [Fault(text, key, fault["input"], allowed or None)]


def _hints(model: type[BaseModel], location: Sequence[int | str]) -> list[str]:
    """Hints for the key at ``location``; for an item or a part of it, those of the whole."""
    for at in reversed(range(len(location))):
        hints = [m.hints for m in _walk(model, location[:at])[1]]
        if found := [of[location[at]] for of in hints if location[at] in of]:
            return found
    return []


def _message(model: type[BaseModel], fault: Any) -> str:
    """Message of a fault, with the wording of this project."""
    if fault["type"] == "model_type":
        return f"needs keys: {', '.join(_allowed_keys(model, fault['loc']))}"
    message = MESSAGES.get(fault["type"], fault["msg"])
    return message.removeprefix("Value error, ").replace("Input should", "should")


def _nearest(model: type[BaseModel], location: Sequence[int | str]) -> list[str]:
    """Known key closest to the unknown one at ``location``, as a list of one or none."""
    return get_close_matches(str(location[-1]), _allowed_keys(model, location[:-1]), n=1)


def _allowed_keys(model: Any, location: Sequence[int | str]) -> list[str]:
    return [name for candidate in _walk(model, location)[1] for name in candidate.model_fields]


def _walk(model: Any, location: Sequence[int | str]) -> tuple[list[str], list[Any]]:
    """Keys along ``location``, and the models at its end.

    Parts of the location that are not keys name the branch of a union chosen by pydantic: they are
    left out of the keys, and only the models of that branch remain.
    """
    keys, models = [], [model]
    for part in location:
        if isinstance(part, str):
            fields = [m.model_fields[part] for m in models if part in m.model_fields]
            if not fields:
                models = [m for m in models if _is_branch(m, part)] or models
                continue
            models = [nested for field in fields for nested in _nested_models(field.annotation)]
        keys.append(str(part))
    return keys, models


def _is_branch(model: Any, tag: str) -> bool:
    """Whether pydantic's ``tag`` of a branch is that of the model: its name or a literal."""
    literals = [get_args(field.annotation) for field in model.model_fields.values()]
    return model.__name__ == tag or any(tag in values for values in literals)


def _nested_models(annotation: Any) -> list[Any]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [m for part in getattr(annotation, "__args__", ()) for m in _nested_models(part)]
