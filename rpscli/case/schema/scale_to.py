"""Targets that records are scaled to: values of intensity measures."""

from __future__ import annotations

import re
from typing import Annotated, Any

from pydantic import (
    AfterValidator,
    BeforeValidator,
    PlainValidator,
    ValidationError,
    ValidationInfo,
    WithJsonSchema,
)

from rpscli.case.schema.fields import DampingRatio, NameOf, Quantity, Section, refuse
from rpscli.errors import hint
from rpscli.records.measures import MEASURES, OF, Measure, Of, needs_period

_TARGET = re.compile(r"\s*([A-Za-z][\w-]*)\s*(?:\(([^)]*)\))?\s*=\s*(.+?)\s*")


def _scalable(name: object) -> object:
    """The name of a measure, unless it is one that no factor changes."""
    if isinstance(name, str) and re.fullmatch(r"ds?5[-_ ]?(75|95)", name.lower()):
        refuse(
            "must not be a duration, which no factor changes; choose records by it with"
            " `rps record select --where 'd5_95=10..30'`"
        )
    return name


MeasureName = Annotated[Measure, NameOf(MEASURES), BeforeValidator(_scalable)]


def measured_value(value: object, info: ValidationInfo) -> float:
    """A value of the measure that stands before it, in SI: a
    number, or text with a unit.
    """
    if (measure := info.data.get("measure")) is None:
        return 1.0  # whatever it is: the measure is refused
    number = Quantity(MEASURES[measure].unit, symbol=measure, above=0).read(value)
    assert isinstance(number, float), "there are no words in place of the number"
    return number


MeasuredValue = Annotated[
    float,
    PlainValidator(measured_value),
    WithJsonSchema(
        {"anyOf": [{"type": "number", "exclusiveMinimum": 0}, {"type": "string"}]}
    ),
]


def _at_period(period: float | None, info: ValidationInfo) -> float | None:
    if not needs_period(measure := info.data.get("measure", "Sa")):
        known = ", ".join(name for name, each in MEASURES.items() if each.at_period)
        refuse(f"belongs to measures such as {known}; {measure} has none, remove it")
    return period


at_period = AfterValidator(_at_period)


class ScaleToSection(Section):
    """A value of an intensity measure of the horizontal record, in place of a factor."""

    measure: MeasureName
    """PGA, Sa, AvgSa [m/s2], PGV, FIV3, CAV, Arias [m/s], PGD
    or Housner [m] when scaled"""
    value: MeasuredValue
    """what it is to be, SI or with a unit, such as 0.4 g"""
    period: Annotated[Annotated[float | None, Quantity("s", above=0)], at_period] = None
    """of Sa, AvgSa or FIV3; left out: the fixed-base first period of the building"""
    damping: DampingRatio = 0.05
    """of Sa, AvgSa or Housner"""
    of: Of | None = None
    """what of a pair of components it is, rotd50, geomean, rotd100, larger or x
    (the first); left out: rotd50 at an angle, and where both are among the
    records; else component, its own"""


def scale_to_of(text: str) -> ScaleToSection:
    """The target that a text asks for: ``PGA=0.4g``, ``Sa(0.6 s)=1
    g``, ``PGV(rotd100)=0.5``.
    """
    match = _TARGET.fullmatch(text)
    if match is None:
        raise ValueError("write MEASURE=VALUE, as in PGA=0.4g, or Sa(0.6 s)=1g")
    name, inside, value = match.groups()
    _scalable(name)
    ours = {known.lower(): known for known in MEASURES}
    if (measure := ours.get(name.lower(), name)) not in MEASURES:
        known = MEASURES.names()
        if measure not in known:
            known_are = f"known are {', '.join(known)}"
            raise ValueError(
                f"{name} is not a measure; {hint(name, known, known_are, 0.6)}"
            )
    given: dict[str, Any] = {"measure": measure, "value": _number(value)}
    if MEASURES[measure].unit == "m/s2" and isinstance(given["value"], float):
        raise ValueError(f"say the unit: {name}={value} g, or {name}={value} m/s2")
    for part in () if inside is None else map(str.strip, inside.split(",")):
        key, read = (
            ("of", part.lower()) if part.lower() in OF else ("period", _number(part))
        )
        if key in given:
            raise ValueError(
                f"({inside}): holds a period and one of {', '.join(OF)} at most"
            )
        given[key] = read
    try:
        return ScaleToSection.model_validate(given)
    except ValidationError as error:
        reasons = error.errors(include_url=False)
        raise ValueError(
            "; ".join(f"{reason['input']!r} {reason['msg']}" for reason in reasons)
        ) from None


def _number(text: str) -> float | str:
    """A bare number, or the text with its unit."""
    try:
        return float(text)
    except ValueError:
        return text
