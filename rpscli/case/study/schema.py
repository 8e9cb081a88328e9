"""The study file as pydantic models: every key, its meaning and bounds.

What `base` and the varied keys hold belongs to the case format and is checked as a case; rules
that join several keys stand in `rules`.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import (
    ConfigDict,
    Discriminator,
    Field,
    PlainValidator,
    Tag,
    ValidationError,
    ValidationInfo,
    WithJsonSchema,
)
from pydantic_core import PydanticCustomError

from rpscli.case.schema.case_file import FORMAT_VERSION, PositiveRatio, Time
from rpscli.case.schema.fields import Quantity, Section, Text, Whole, first_fault, is_finite, refuse
from rpscli.case.schema.limits import LimitsSection
from rpscli.case.schema.scale_to import measured_value
from rpscli.case.text.document import shown
from rpscli.records.measures import Measure

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


Analysis = Literal["timehistory", "modal", "pushover"]


class MeasureScale(Section):
    """Every record scaled to given values of an intensity measure."""

    measure: Measure = Field(
        description="PGA, Sa [m/s2], PGV, CAV, Arias [m/s] or PGD [m] of the scaled record"
    )
    values: MeasuredValues = Field(description="values to scale to, SI or with a unit")
    period: Time | None = Field(
        None, description="of Sa; left out: the fixed-base first period of each system"
    )
    damping: DampingRatio = Field(0.05, description="of Sa")


def _kind_of_scale(value: object) -> str:
    measured = isinstance(value, dict) and "measure" in value
    return "measure" if measured or isinstance(value, MeasureScale) else "factors"


Scale = Annotated[
    Annotated[MeasureScale, Tag("measure")] | Annotated[Numbers, Tag("factors")],
    Discriminator(_kind_of_scale),
]
"""Factors on the records, or what to scale them to."""


class RangeSection(Section):
    """What an uncertain parameter may be: uniform between bounds, or a distribution."""

    low: Number | None = Field(None, description="lower bound of a uniform distribution")
    high: Number | None = Field(None, description="upper bound of a uniform distribution")
    distribution: Literal["uniform", "normal", "lognormal"] = Field(
        "uniform", description="its kind; all but bounds need mean and cov"
    )
    mean: Number | None = Field(None, description="mean value")
    cov: PositiveRatio | None = Field(None, description="standard deviation over mean")


class SampleSection(Section):
    """A sample of uncertain parameters, by a low-discrepancy or stratified sequence."""

    method: Literal["sobol", "latin_hypercube"] = Field("sobol", description="kind of sequence")
    size: Annotated[int, Whole(1)] = Field(description="number of sampled systems")
    seed: Seed = Field(1, description="of the scrambling; the same seed gives the same sample")
    ranges: dict[str, tuple[Number, Number] | RangeSection] = Field(
        description="dotted case keys with [low, high] or a distribution"
    )


class PerturbSection(Section):
    """An ensemble of small perturbations around every point."""

    scale: Share = Field(0.01, description="largest change of the record's scale, relative")
    restitution: Share = Field(0.01, description="largest change of the restitution, relative")
    members: Annotated[int, Whole(2)] = Field(
        20, description="points in place of one; the first is the unperturbed one"
    )
    seed: Seed = Field(1, description="of the perturbations, which are the same at every point")


class RecordPattern(Section):
    """One source with options that take several values: the product of all of them."""

    model_config = ConfigDict(extra="allow", frozen=True)

    source: Text = Field(description="a pulse or a synthetic motion, without the varied options")


class StudyParts(Section):
    """What studies and designs say of a case, its records and its limits."""

    rps: Annotated[
        int, Whole(FORMAT_VERSION, FORMAT_VERSION, "this program reads version 1 of the format")
    ] = Field(description="version of the format; write `rps: 1`")
    title: Text | None = Field(None, description="heading of reports and plots")
    base: Text | dict[str, Any] = Field(
        description="a case file, seen from the study's folder, or the case itself"
    )
    records: tuple[Text | RecordPattern, ...] | None = Field(
        None, description="record sources, folders, globs; left out: the record of the case"
    )
    scale: Scale | None = Field(
        None, description="factors on the records, or values of a measure to scale them to"
    )
    whole_histories: bool = Field(
        default=False,
        description="follow each history by itself, with all its samples: roof displacement, floor"
        " velocity, forces of a column, base shear over that of the fixed base; far slower",
    )
    limits: LimitsSection | None = Field(
        None, description="judge the study in place of those of its base; exceeded: exit code 10"
    )


class StudyFile(StudyParts):
    """A study of rps: many points from one case."""

    analysis: Analysis = Field("timehistory", description="what is done at every point")
    vary: tuple[dict[str, tuple[Any, ...] | ValueRange], ...] = Field(
        (), description="axes of a product; the keys of one axis go together"
    )
    sample: SampleSection | None = Field(None, description="uncertain parameters; one more axis")
    perturb: PerturbSection | None = Field(
        None, description="small perturbations around every point"
    )
    observed: Text | None = Field(
        None, description="CSV file of what was observed under records; for the report comparison"
    )
    reports: tuple[str | dict[str, Any], ...] = Field(
        (), description="names of reports, or `name: {option: value}`"
    )
