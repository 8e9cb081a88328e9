"""Kinds of field that only studies have: several keys, several numbers, equally spaced values."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, PlainValidator, ValidationError, ValidationInfo, WithJsonSchema
from pydantic_core import PydanticCustomError

from rpscli.case.schema.fields import Quantity, Whole, first_fault, is_finite, refuse
from rpscli.case.schema.scale_to import measured_value
from rpscli.case.schema.section import Section
from rpscli.case.text.faults import shown

Number = Annotated[float, Quantity()]
Seed = Annotated[int, Whole(0)]
DampingRatio = Annotated[
    float,
    Quantity(symbol="of critical damping", at_least=0, below=1, remedy="5 % is 0.05"),
]
Share = Annotated[
    float,
    Quantity(symbol="share of the value", at_least=0, below=1, remedy="1 % is 0.01"),
]


class ValueRange(Section):
    """Equally spaced values in place of a list."""

    low: Number = Field(description="first value")
    high: Number = Field(description="last value")
    count: Annotated[int, Whole(2, 1_000_000)] = Field(description="how many, both ends included")
    spacing: Literal["linear", "log"] = Field("linear", description="equal steps or equal ratios")


def spaced(section: ValueRange) -> tuple[float, ...]:
    """The values of a range; twelve digits, so that 0.1 to 0.3 in three steps has 0.2 in it.

    Raises
    ------
    ValueError
        If a logarithmic range has a bound that is not positive.

    Examples
    --------
    >>> spaced(ValueRange(low=0.1, high=0.3, count=3))
    (0.1, 0.2, 0.3)
    >>> spaced(ValueRange(low=0.1, high=10.0, count=3, spacing="log"))
    (0.1, 1.0, 10.0)
    """
    low, high, last = section.low, section.high, section.count - 1
    if section.spacing == "linear":
        values = [low + (high - low) * i / last for i in range(section.count)]
    elif low > 0.0 and high > 0.0:
        values = [low * (high / low) ** (i / last) for i in range(section.count)]
    else:
        raise ValueError("equal ratios need low and high > 0; use spacing: linear")
    return tuple(float(f"{value:.12g}") for value in values)


def _numbers(value: object, *, above: float | None = None) -> tuple[float, ...]:
    """One number, a list of them, or a range."""
    if isinstance(value, dict):
        return _of_range(value, above)
    listed = list(value) if isinstance(value, list | tuple) else [value]
    if not listed:
        refuse("must not be an empty list")
    return tuple(_number(item, above) for item in listed)


def _of_range(value: dict[str, Any], above: float | None) -> tuple[float, ...]:
    try:
        values = spaced(ValueRange.model_validate(value))
    except ValidationError as error:
        refuse(f"is no range {{low, high, count, spacing}}: {first_fault(error)}")
    except ValueError as error:
        refuse(str(error))
    return tuple(_number(item, above) for item in values)


def _number(item: object, above: float | None) -> float:
    if not is_finite(item):
        refuse(f"must be finite numbers, or {{low, high, count}}; {shown(item)} is none")
    if above is not None and not float(item) > above:
        refuse(f"must hold values > {above:g}; {shown(item)} is not")
    return float(item)


def _positive_numbers(value: object) -> tuple[float, ...]:
    return _numbers(value, above=0.0)


def _measured_values(value: object, info: ValidationInfo) -> tuple[float, ...]:
    """Values of the measure that stands before them, in SI: numbers, or texts with a unit."""

    def in_si(item: object) -> object:
        try:
            return measured_value(item, info) if isinstance(item, str) else item
        except PydanticCustomError as error:
            refuse(f"has {shown(item)}, which {error}")

    if isinstance(value, dict):
        ends = {key: in_si(item) for key, item in value.items() if key in {"low", "high"}}
        return _positive_numbers(value | ends)
    listed = list(value) if isinstance(value, list | tuple) else [value]
    return _positive_numbers([in_si(item) for item in listed])


def _keys(value: object) -> tuple[str, ...]:
    listed = list(value) if isinstance(value, list | tuple) else [value]
    if not all(isinstance(item, str) and item.strip() for item in listed):
        refuse("must be a key or a list of keys, as text")
    return tuple(str(item) for item in listed)


def _schema(one: str) -> WithJsonSchema:
    several = {"type": "array", "items": {"type": one}, "minItems": 1}
    return WithJsonSchema({"anyOf": [{"type": one}, several]})


_SPACED = {
    "type": "object",
    "required": ["low", "high", "count"],
    "properties": {
        "low": {"type": "number"},
        "high": {"type": "number"},
        "count": {"type": "integer", "minimum": 2},
        "spacing": {"enum": ["linear", "log"]},
    },
    "additionalProperties": False,
}
_NUMBERS = WithJsonSchema(
    {"anyOf": [{"type": "number"}, {"type": "array", "items": {"type": "number"}}, _SPACED]}
)

Numbers = Annotated[tuple[float, ...], PlainValidator(_numbers), _NUMBERS]
"""One number, several, or a range of them."""

PositiveNumbers = Annotated[tuple[float, ...], PlainValidator(_positive_numbers), _NUMBERS]
"""The same, each above zero."""

MeasuredValues = Annotated[
    tuple[float, ...],
    PlainValidator(_measured_values),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": ["number", "string"]},
                {"type": "array", "items": {"type": ["number", "string"]}},
                _SPACED,
            ]
        }
    ),
]
"""The same, of an intensity measure, with or without a unit."""

Keys = Annotated[tuple[str, ...], PlainValidator(_keys), _schema("string")]
"""One key or several."""
