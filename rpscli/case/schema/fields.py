"""Kinds of field: what a value of a file may be, and its JSON schema.

Each is a mark inside `typing.Annotated` from which pydantic takes the check and the
schema, so that bounds, unit and meaning stand once, beside the field.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from numbers import Integral, Real
from typing import Annotated, Any, Literal, NoReturn, Self

import numpy as np
from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    PlainValidator,
    WithJsonSchema,
    create_model,
    model_validator,
)
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from rpscli.errors import (
    LARGEST,
    SMALLEST,
    PluginError,
    hint,
    is_number,
    listed,
    nearest,
    told,
)
from rpscli.registry import Registry, blaming
from rpscli.units import KINDS, Written, computed_remedy, si_value


class Section(BaseModel):
    """A mapping of the file: unknown keys are refused, and nothing changes later.

    The text below a key is its description; validators are built
    when they are first used.
    """

    model_config = ConfigDict(
        extra="forbid", frozen=True, use_attribute_docstrings=True, defer_build=True
    )

    @classmethod
    def __pydantic_init_subclass__(cls, **_: object) -> None:
        """Descriptions are one line, however they stand in the source."""
        for each in cls.model_fields.values():
            each.description = each.description and " ".join(each.description.split())

    @classmethod
    def build(cls) -> None:
        """Build what was put off, of all sections: pydantic before
        2.14 dumps none without.
        """
        cls.model_rebuild()
        for section in cls.__subclasses__():
            section.build()


PLAIN = "1"
"""Unit of a plain number."""
CHECKED_BY_ITSELF = "checked by itself"
"""Marks a field whose inside is checked against another model."""


def refuse(reason: str) -> NoReturn:
    """Refuse a value; `reason` continues `path = value ...`."""
    raise PydanticCustomError("rps", "{reason}", {"reason": reason})


BOUNDS: dict[str, tuple[str, Callable[[float, float], bool], str]] = {
    "above": (">", operator.gt, "exclusiveMinimum"),
    "at_least": (">=", operator.ge, "minimum"),
    "below": ("<", operator.lt, "exclusiveMaximum"),
    "at_most": ("<=", operator.le, "maximum"),
}
"""Sign, comparison, and key in JSON schemas."""


class Mark:
    """A rule for values: `read` refuses others, and `json_schema` describes it."""

    read: Callable[..., Any]
    json_schema: Callable[..., dict[str, Any]]

    def __get_pydantic_core_schema__(self, *_: object) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(self, *_: object) -> dict[str, Any]:
        return self.json_schema()


@dataclass(frozen=True)
class Quantity(Mark):
    """A number in SI, or text with a unit."""

    unit: str = PLAIN
    symbol: str = ""
    above: float | None = None
    at_least: float | None = None
    below: float | None = None
    at_most: float | None = None
    remedy: str = ""
    words: tuple[str, ...] = ()
    per_storey: bool = False

    def __post_init__(self) -> None:
        """Refuse a unit that is none of those known."""
        if self.unit == "-":
            object.__setattr__(self, "unit", PLAIN)
        if self.unit not in (known := [PLAIN, *KINDS]):
            raise ValueError(
                f"the unit {told(self.unit)[:40]} of a Quantity is not known; known are"
                f" {listed(known, 'and')}"
            )

    @cached_property
    def _bounds(self) -> dict[str, float]:
        bounds = {name: getattr(self, name) for name in BOUNDS}
        return {name: bound for name, bound in bounds.items() if bound is not None}

    @property
    def rule(self) -> str:
        """The bounds in words, such as ``> 0 and <= 1``."""
        return " and ".join(
            f"{BOUNDS[name][0]} {b:g}" for name, b in self._bounds.items()
        )

    def read(self, value: object) -> float | str:
        """The SI value, or the word; raises pydantic's error if it is neither."""
        unit = "" if self.unit == PLAIN else f" {self.unit}"
        text = value if isinstance(value, str) else ""
        if text in self.words:
            return text
        if isinstance(value, str):
            value = self._with_unit(value)
        if isinstance(value, bool) or not isinstance(value, Real):
            refuse(self._not_a_number)
        if not is_number(value):
            refuse("must be a finite number")
        x = float(value)
        if not all(BOUNDS[name][1](x, bound) for name, bound in self._bounds.items()):
            symbol = f" ({self.symbol})" if self.symbol else ""
            remedy = f"; {self.remedy}" if self.remedy else ""
            refuse(f"must be {self.rule}{unit}{symbol}{remedy}")
        if x and not SMALLEST <= abs(x) <= LARGEST:
            refuse(f"is outside {SMALLEST:g} ... {LARGEST:g}{unit}; check the unit")
        return Written(x, text) if text else x

    @property
    def _not_a_number(self) -> str:
        words = "".join(f", or the word {word}" for word in self.words)
        kind = (
            "a number" if self.unit == PLAIN else f"{KINDS[self.unit][0]} in {self.unit}"
        )
        return f"must be {kind}{words}"

    def _with_unit(self, text: str) -> float:
        if suggestion := nearest(text, self.words):
            refuse(f"{self._not_a_number}; did you mean {suggestion}?")
        if self.unit == PLAIN:
            share = ", as 0.05 for 5 %" * ("%" in text)
            refuse(
                f"is text; it {self._not_a_number}, without unit and without"
                f" quotes{share}{computed_remedy(text, self.unit)}"
            )
        try:
            return si_value(text, self.unit)
        except ValueError as error:
            refuse(f"{error}{computed_remedy(text, self.unit)}")

    def __get_pydantic_core_schema__(self, *_: object) -> CoreSchema:
        """The check, for pydantic, of one value or of a list."""
        one = super().__get_pydantic_core_schema__()
        if not self.per_storey:
            return one
        each = core_schema.tuple_schema([one], variadic_item_index=0, min_length=1)
        return core_schema.tagged_union_schema(
            {"one": one, "each": each},
            discriminator=lambda value: (
                "each" if isinstance(value, list | tuple) else "one"
            ),
        )

    def json_schema(self) -> dict[str, Any]:
        """The JSON schema; its ``unit`` is the SI unit of a bare number."""
        bounds = {BOUNDS[name][2]: bound for name, bound in self._bounds.items()}
        forms: list[dict[str, Any]] = [{"type": "number"} | bounds]
        if self.unit != PLAIN:
            inverse = "(1/)?" if self.unit.startswith("1/") else ""
            number = r"^\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*"
            pattern = rf"{number}{inverse}[^\d\s].*$"
            units = f"with unit: {listed(KINDS[self.unit][1])}"
            forms.append({"type": "string", "pattern": pattern, "description": units})
        if self.words:
            forms.append({"enum": list(self.words)})
        if self.per_storey:
            items = {"anyOf": [*forms]} if len(forms) > 1 else forms[0]
            forms.append({"type": "array", "items": items, "minItems": 1})
        extra = {"symbol": self.symbol} if self.symbol else {}
        return (
            ({"anyOf": forms} if len(forms) > 1 else forms[0])
            | {"unit": self.unit}
            | extra
        )


@dataclass(frozen=True)
class Whole(Mark):
    """A whole number between bounds, both inclusive."""

    at_least: int
    at_most: int | None = None
    remedy: str = ""

    def read(self, value: object) -> int:
        """The value; raises pydantic's error if it is not one."""
        if isinstance(value, bool) or not isinstance(value, Integral):
            whole = (
                isinstance(value, float) and value.is_integer() and f"; write {value:.0f}"
            )
            refuse(f"must be a whole number{whole or ''}")
        number = int(value)
        if number < self.at_least or (self.at_most is not None and number > self.at_most):
            refuse(
                "must be a whole number"
                f" {self.rule}{f'; {self.remedy}' if self.remedy else ''}"
            )
        return number

    @property
    def rule(self) -> str:
        """The bounds in words."""
        if self.at_most is None:
            return f">= {self.at_least}"
        if self.at_most == self.at_least:
            return f"equal to {self.at_least}"
        return f"from {self.at_least} to {self.at_most}"

    def json_schema(self) -> dict[str, Any]:
        """The JSON schema."""
        most = {} if self.at_most is None else {"maximum": self.at_most}
        return {"type": "integer", "minimum": self.at_least} | most


@dataclass(frozen=True, eq=False)
class NameOf(Mark):
    """One of the names in a registry, of ours or of other packages."""

    registry: Registry[Any]

    @property
    def names(self) -> list[str]:
        """All of them."""
        return self.registry.names()

    def read(self, value: object) -> str:
        """The name; raises pydantic's error if it is none of them."""
        if isinstance(value, str) and (value in self.registry or value in self.names):
            return value
        meant = nearest(str(value), self.names)
        refuse(
            f"must be {listed(self.names)}"
            + (f"; did you mean {meant}?" if meant else "")
        )

    def json_schema(self) -> dict[str, Any]:
        """The JSON schema."""
        return {"enum": self.names, "type": "string"}


DampingRatio = Annotated[
    float,
    Quantity(symbol="of critical damping", at_least=0, below=1, remedy="5 % is 0.05"),
]


def _two(value: object) -> object:
    if not isinstance(value, list | tuple) or len(value) != 2:
        refuse(
            "must be two modes, as in [1, 2]; leave modes out to damp every mode equally"
        )
    return value


Mode = Annotated[int, Whole(1, remedy="modes count from 1")]
_MODES = {
    "type": "array",
    "items": {"type": "integer", "minimum": 1},
    "minItems": 2,
    "maxItems": 2,
}
ModePair = Annotated[tuple[Mode, Mode], BeforeValidator(_two), WithJsonSchema(_MODES)]
"""Two modes of vibration, counted from 1."""


def _text(value: object) -> str:
    if not isinstance(value, str):
        refuse("must be text; put it in quotes")
    if not value.strip():
        refuse("must not be empty text; write something, or remove the key")
    return value


Text = Annotated[
    str, PlainValidator(_text), WithJsonSchema({"type": "string", "minLength": 1})
]
"""Text that says something."""


def must_be(
    kinds: type | tuple[type, ...], text: str, *, filled: bool = False
) -> BeforeValidator:
    """A value of some kinds; `text` says what it is if not."""

    def check(value: object) -> object:
        if not isinstance(value, kinds) or (filled and not value):
            refuse(f"must be {text}")
        return value

    return BeforeValidator(check)


class ValueRange(Section):
    """Equally spaced values in place of a list."""

    low: Annotated[float, Quantity()]
    """first value"""
    high: Annotated[float, Quantity()]
    """last value"""
    count: Annotated[int, Whole(2, 1_000_000)]
    """how many, both ends included"""
    spacing: Literal["linear", "log"] = "linear"
    """equal steps or equal ratios"""

    @model_validator(mode="after")
    def _has_ratios(self) -> Self:
        if self.spacing == "log" and not (self.low > 0.0 and self.high > 0.0):
            refuse("must have low and high > 0 for equal ratios; use spacing: linear")
        return self

    @property
    def values(self) -> tuple[float, ...]:
        """Twelve digits, so that 0.1 to 0.3 in three steps has 0.2 in it."""
        spaced = np.linspace if self.spacing == "linear" else np.geomspace
        values = spaced(self.low, self.high, self.count).tolist()
        return tuple(float(f"{value:.12g}") for value in values)


@dataclass(frozen=True)
class Several:
    """One value, a list of them, or numbers at equal spaces; in
    each case a tuple of values.
    """

    item: Any
    alone: bool = True
    spaced: bool = True
    least: int = 1

    def __get_pydantic_core_schema__(
        self, _: object, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        item = handler.generate_schema(self.item)
        after = core_schema.no_info_after_validator_function
        each = core_schema.tuple_schema(
            [item], variadic_item_index=0, min_length=self.least
        )
        forms: dict[Any, CoreSchema] = {"a list": each}
        if self.alone:
            forms["a value"] = after(lambda value: (value,), item)
        if self.spaced:
            spaced = after(
                lambda section: section.values, handler.generate_schema(ValueRange)
            )
            forms["a range"] = core_schema.chain_schema([spaced, each])

        def form(value: object) -> str:
            if isinstance(value, list | tuple):
                return "a list"
            return "a range" if self.spaced and isinstance(value, dict) else "a value"

        return core_schema.tagged_union_schema(
            forms,
            discriminator=form,
            custom_error_type="rps",
            custom_error_message="must be a list of values, or {low, high, count}",
        )


def _blamed(section: type[Section], schema: CoreSchema) -> CoreSchema:
    """The schema of a section: what validators of another package raise is theirs, but
    for what pydantic tells at its key.
    """
    if section.__module__.startswith("rpscli."):
        return schema
    owner = f"{section.__qualname__}, options of {section.__module__}"

    def checked(value: Any, ours: Any) -> object:
        with blaming(owner, ValueError):
            return ours(value)

    return core_schema.no_info_wrap_validator_function(checked, schema)


@dataclass(frozen=True)
class OneOf:
    """A mapping that is one of several kinds of section, under its name:
    ``name: {option: value}``.

    In JSON schemas a name may stand alone, as where a file is read before it is checked.
    """

    what: str
    sections: Mapping[str, type[Section]]
    gone: Mapping[str, str] = field(default_factory=dict)

    def name_of(self, value: object) -> str:
        """The kind of a value; refuses what has none."""
        if not isinstance(value, str) and not (
            isinstance(value, dict) and len(value) == 1
        ):
            refuse("must be a name, or one `name: {option: value}`")
        name = value if isinstance(value, str) else str(next(iter(value)))
        if name not in self.sections and (now := self.gone.get(name)):
            refuse(f"is gone: {now}")
        if name not in self.sections:
            known = f"known are {listed(self.sections, 'and')}"
            refuse(f"is not a {self.what}; {hint(name, self.sections, known)}")
        return name

    def __get_pydantic_core_schema__(
        self, _: object, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        def inside(value: Any) -> object:
            (options,) = value.values()
            if not isinstance(options, dict):
                refuse("must be a mapping of options")
            return options

        before = core_schema.no_info_before_validator_function
        kinds: dict[Any, CoreSchema] = {
            name: before(inside, _blamed(section, handler.generate_schema(section)))
            for name, section in self.sections.items()
        }
        union = core_schema.tagged_union_schema(kinds, self.name_of)
        return before(lambda value: self.name_of(value) and value, union)

    def __get_pydantic_json_schema__(
        self, schema: Any, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        kinds = schema["schema"]["choices"].items()
        one = {
            "type": "object",
            "minProperties": 1,
            "maxProperties": 1,
            "additionalProperties": False,
            "properties": {
                k: {"anyOf": [handler(each), {"type": "null"}]} for k, each in kinds
            },
        }
        return {"anyOf": [{"enum": list(self.sections)}, one]}


@dataclass(frozen=True, eq=False)
class OwnLaws:
    """A section of ours, or where `key` names a law of another package
    that with its constants.

    They are keys like ours, known once a document names the law.
    """

    key: str
    registry: Registry[Any]
    ours: type[Section]
    loaded: dict[str, type[Section]] = field(default_factory=dict)
    """By the names of laws, those that were asked for."""

    def section(self, name: str) -> type[Section]:
        """The section of a law: raises PluginError if its constants cannot be keys."""
        if name not in self.loaded:
            constants = self.registry[name].constants
            with self.registry.blaming(name):
                if taken := [*constants.keys() & self.ours.model_fields.keys()]:
                    raise ValueError(
                        f"its constant {taken[0]} must not be a key of rps; rename it"
                    )
                keys: dict[str, Any] = {
                    constant: (
                        Annotated[float, quantity],
                        Field(description=f"of {name}"),
                    )
                    for constant, quantity in constants.items()
                }
                keys[self.key] = (Literal[name], Field(description="of another package"))
                self.loaded[name] = create_model(name, __base__=self.ours, **keys)
        return self.loaded[name]

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        def checked(value: Any, ours: Any) -> object:
            name = value.get(self.key) if isinstance(value, dict) else None
            if not isinstance(name, str) or name in self.registry:
                return ours(value)
            known = name in self.registry.names()
            return self.section(name).model_validate(value) if known else ours(value)

        return core_schema.no_info_wrap_validator_function(checked, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: Any, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        own = []
        for name, _ in self.registry.theirs():
            with suppress(PluginError):  # told where it is asked for
                own.append(self.section(name).model_json_schema())
        return {"anyOf": [handler(schema), *own]} if own else handler(schema)
