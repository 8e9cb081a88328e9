"""The study file as pydantic models: every key, its meaning and bounds.

What `base` and the varied keys hold belongs to the case format and is checked as a case;
rules that join several keys stand in `study`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal, Self

from pydantic import (
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    GetJsonSchemaHandler,
    PlainValidator,
    Tag,
    ValidationInfo,
    WithJsonSchema,
    create_model,
    model_validator,
)
from pydantic_core import CoreSchema

from rpscli.case.schema.case_file import DocumentSection, PositiveRatio, Time, TitledFile
from rpscli.case.schema.fields import (
    CHECKED_BY_ITSELF,
    PLAIN,
    DampingRatio,
    Quantity,
    Section,
    Several,
    Text,
    Whole,
    must_be,
    refuse,
)
from rpscli.case.schema.keys import unit
from rpscli.case.schema.limits import WITHOUT_SOURCE, StudyLimits
from rpscli.case.schema.scale_to import (
    MeasuredValue,
    MeasureName,
    at_period,
    measured_value,
)
from rpscli.case.study.tool_key import TOOL_KEYS
from rpscli.case.text.document import Position, shown
from rpscli.errors import LARGEST, is_number
from rpscli.records.measures import Of
from rpscli.records.recordings import By
from rpscli.units import in_si

Number = Annotated[float, Quantity()]
Seed = Annotated[int, Whole(0)]
Share = Annotated[
    float,
    Quantity(symbol="share of the value", at_least=0, below=1, remedy="1 % is 0.01"),
]
PositiveNumber = Annotated[float, Quantity(above=0)]


def _ends_in_si(value: object, info: ValidationInfo) -> object:
    """Ends of a range with the unit of the measure that stands before it."""
    if not isinstance(value, dict):
        return value
    ends = {key: value[key] for key in ("low", "high") if isinstance(value.get(key), str)}
    return value | {key: measured_value(end, info) for key, end in ends.items()}


_NUMBER = {"type": ["number", "string"]}
Option = Annotated[
    Any,
    must_be((int, float, str), "a value or a list of values"),
    WithJsonSchema(_NUMBER),
]
InUnit = Annotated[float, Quantity(), WithJsonSchema(_NUMBER)]
"""A number, or in the file a text with the unit of a key."""
Key = Annotated[str, must_be(str, "a key or a list of keys, as text", filled=True)]
Keys = Annotated[tuple[str, ...], Several(Key, spaced=False)]
"""One key or several."""
AnyKeys = Annotated[tuple[str, ...], Several(Key, spaced=False, least=0)]
"""One key, several, or none."""

Numbers = Annotated[tuple[float, ...], Several(Number)]
"""One number, several, or a range of them."""

PositiveNumbers = Annotated[tuple[float, ...], Several(PositiveNumber)]
"""Numbers above zero: one, several, or a range of them."""

MeasuredValues = Annotated[
    tuple[float, ...], Several(MeasuredValue), BeforeValidator(_ends_in_si)
]
"""Values of an intensity measure, with or without a unit: one, several, or a range."""

Axes = Annotated[
    tuple[
        Annotated[
            dict[str, Annotated[tuple[Any, ...], Several(Any, alone=False)]],
            must_be(dict, "a mapping `dotted.key: [value, value]`", filled=True),
        ],
        ...,
    ],
    must_be(list, "a list of axes, each a mapping: `- dotted.key: [value, value]`"),
]
"""Values of keys that vary together, axis by axis."""


Values = tuple[Any, ...]


@dataclass(frozen=True)
class Axis:
    """Keys that go together, a row of values for each position, where each was written,
    and names of the rows, if they have any.
    """

    keys: tuple[str, ...]
    rows: tuple[Values, ...]
    places: tuple[tuple[Position, ...], ...]
    of_designs: bool = False
    labels: tuple[str, ...] = ()

    @property
    def naming(self) -> tuple[str, ...]:
        """Keys that name a row: the first, but all of designs, and
        where it has a value twice.
        """
        twice = len({repr(row[0]) for row in self.rows}) < len(self.rows)
        return self.keys if twice or self.of_designs else self.keys[:1]

    def place(self, key: int, row: int) -> Position:
        """Position of a value in the file."""
        places = self.places[key]
        return places[row] if len(places) == len(self.rows) else places[0]


LABELS = "labels"
"""Among the keys of an axis: names of its rows."""

PLUS = "plus"
"""What is added to a linear sum."""


def is_moderate(value: object) -> bool:
    """A number whose sums and products with others stay finite."""
    return is_number(value) and abs(value) <= LARGEST


def with_keys(value: object) -> object:
    """Each value with its key, whose unit it may have."""
    return (
        {key: (key, of) for key, of in value.items()}
        if isinstance(value, dict)
        else value
    )


def _linear(given: tuple[str, object]) -> dict[str, float]:
    key, terms = given
    if isinstance(terms, dict) and PLUS in terms:
        terms = terms | {PLUS: in_si(terms[PLUS], unit(key))}
    if not isinstance(terms, dict) or not all(map(is_moderate, terms.values())):
        refuse(
            "must be a linear sum, {key: factor, plus: number}, of numbers up to"
            f" {LARGEST:g}"
        )
    return terms


_TERMS = {"type": "object", "additionalProperties": {"type": "number"}} | {
    "properties": {PLUS: _NUMBER}
}
Linked = Annotated[
    dict[
        str, Annotated[dict[str, float], PlainValidator(_linear), WithJsonSchema(_TERMS)]
    ],
    BeforeValidator(with_keys),
]
"""Keys that are linear sums of others."""


Analysis = Literal["timehistory", "modal", "pushover"]


class MeasureScale(Section):
    """Every record scaled to given values of an intensity measure."""

    measure: MeasureName
    """PGA, Sa, AvgSa [m/s2], PGV, FIV3, CAV, Arias [m/s], PGD
    or Housner [m] when scaled"""
    values: MeasuredValues
    """values to scale to, SI or with a unit"""
    period: Annotated[Time | None, at_period] = None
    """of Sa, AvgSa or FIV3; left out: the fixed-base first period of each system"""
    damping: DampingRatio = 0.05
    """of Sa, AvgSa or Housner"""
    of: Of | None = None
    """what of a pair of components it is, rotd50, geomean, rotd100, larger or x
    (the first); left out: rotd50 at an angle, and where both are among the
    records; else component, its own"""


Scale = Annotated[
    Annotated[MeasureScale, Tag("to a measure")] | Annotated[Numbers, Tag("by factors")],
    Discriminator(
        lambda value: (
            "to a measure"
            if isinstance(value, MeasureScale)
            or (isinstance(value, dict) and "measure" in value)
            else "by factors"
        )
    ),
]
"""Factors on the records, or what to scale them to."""


class RangeSection(Section):
    """What an uncertain parameter may be: uniform between bounds, or a distribution."""

    low: InUnit | None = None
    """lower bound of a uniform distribution"""
    high: InUnit | None = None
    """upper bound of a uniform distribution"""
    distribution: Literal["uniform", "normal", "lognormal"] = "uniform"
    """its kind; all but bounds need mean and cov"""
    mean: InUnit | None = None
    """mean value"""
    cov: PositiveRatio | None = None
    """standard deviation over mean"""

    @classmethod
    def __get_pydantic_json_schema__(
        cls, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """The JSON schema: the bounds alone may stand in place of the mapping."""
        items = {"type": "array", "items": _NUMBER, "minItems": 2, "maxItems": 2}
        return {"anyOf": [handler(schema), items]}

    @model_validator(mode="before")
    @classmethod
    def _of_bounds(cls, value: object) -> object:
        if isinstance(value, list | tuple) and len(value) == 2:
            return {"low": value[0], "high": value[1]}
        if not isinstance(value, dict):
            refuse("must be [low, high], or {distribution: normal, mean: ..., cov: ...}")
        return value

    @model_validator(mode="after")
    def _complete(self) -> Self:
        ends = (self.low, self.high)
        moments = (self.mean, self.cov)
        uniform = (
            None not in ends
            and moments == (None, None)
            and self.distribution == "uniform"
        )
        if not uniform and (None in moments or ends != (None, None)):
            refuse(
                "must have low and high alone (uniform), or distribution, mean and cov"
            )
        if uniform and not self.low < self.high:  # type: ignore[operator]
            refuse(
                f"has low = {shown(self.low)}, which must be < high = {shown(self.high)}"
            )
        if self.distribution == "lognormal" and not (self.mean or 0.0) > 0.0:
            refuse(
                f"has mean = {shown(self.mean)}, which must be > 0 for a lognormal"
                " distribution"
            )
        if self.mean == 0.0:
            refuse("has mean = 0, and cov is relative to it")
        return self


def _range(given: tuple[str, object]) -> object:
    """A range whose texts are numbers in the unit of its key."""
    key, of = given
    read = Quantity(unit(key).replace("-", PLAIN)).read
    if isinstance(of, list | tuple):
        return [read(end) if isinstance(end, str) else end for end in of]
    if not isinstance(of, dict):
        return of
    texts = (name for name in ("low", "high", "mean") if isinstance(of.get(name), str))
    return of | {name: read(of[name]) for name in texts}


Ranges = Annotated[
    dict[str, Annotated[RangeSection, BeforeValidator(_range)]],
    BeforeValidator(with_keys),
    must_be(
        dict,
        "keys with their ranges, as in {podium.impact.factor: [0.9, 1]}",
        filled=True,
    ),
]


class SampleSection(Section):
    """A sample of uncertain parameters, by a low-discrepancy or stratified sequence."""

    method: Literal["sobol", "latin_hypercube"] = "sobol"
    """kind of sequence"""
    size: Annotated[int, Whole(1)]
    """number of sampled systems"""
    seed: Seed = 1
    """of the scrambling; the same seed gives the same sample"""
    ranges: Ranges
    """dotted case keys with [low, high] or a distribution, SI or with a unit"""


class PerturbSection(Section):
    """An ensemble of small perturbations around every point."""

    scale: Share = 0.01
    """largest change of the record's scale, relative"""
    restitution: Share = 0.01
    """largest change of the restitution, relative"""
    rotation: Annotated[float, Quantity("deg", at_least=0, at_most=45)] = 1.0
    """largest turn of a pair whose components act together;
    matters with superstructure.y"""
    members: Annotated[int, Whole(2)] = 20
    """points in place of one; the first is the unperturbed one"""
    seed: Seed = 1
    """of the perturbations, which are the same at every point"""


class HazardSection(Section):
    """A hazard curve: how often a year each intensity is exceeded at the site."""

    file: Text
    """CSV with the header `PGV [cm/s],rate [1/year]`, and fractiles behind it, `0.16
    [1/year]`; seen from the study's folder"""
    measure: MeasureName
    """of its first column"""
    component: Of | None = None
    """what of a pair of components it is of, as `of` in `scale`;
    said if it is not the same"""


class RecordPattern(Section):
    """One source with options that take several values: the product of all of them."""

    model_config = ConfigDict(extra="allow", frozen=True)
    __pydantic_extra__: dict[str, Annotated[tuple[Any, ...], Several(Option)]]

    source: Text
    """a pulse or a synthetic motion, without the varied options"""


Source = Annotated[
    Annotated[Text, Tag("text")] | Annotated[RecordPattern, Tag("pattern")],
    Discriminator(lambda value: "text" if isinstance(value, str) else "pattern"),
    must_be(
        (str, dict),
        "a source, or a mapping with a source and options:"
        " {source: 'pulse:sine?amplitude=1 g', period: [0.5, 1]}",
    ),
]
Sources = Annotated[
    tuple[Source, ...],
    must_be(list, "a list of sources, as in [fema_p695:*]", filled=True),
]


Base = Annotated[
    str | dict[str, Any],
    must_be((str, dict), "a file, as text, or a case, as a mapping", filled=True),
    CHECKED_BY_ITSELF,
]
A_LIST = must_be(list, "a list, as in [overturning, fragility]")


class StudyParts(TitledFile):
    """Keys of studies and designs about a case, its records and its limits."""

    base: Base
    """a case file, seen from the study's folder, or the case itself"""
    records: Sources | None = None
    """record sources, folders, globs; left out: the record of the case"""
    scale: Scale | None = None
    """factors on the records, or values of a measure to scale them to"""
    independent: By = "recordings"
    """what intervals, bootstraps and held-out parts take as a whole: recordings, of which
    all components and angles are one, or events"""
    whole_histories: bool = False
    """follow each history by itself, with all its samples: roof displacement, floor
    velocity, forces of a column, base shear over that of the fixed base; far slower"""
    perturb: PerturbSection | None = None
    """small perturbations around every point"""
    limits: StudyLimits | None = None
    """what is required, in place of the limits of the base; exceeded: exit code 10"""
    hazard: HazardSection | None = None
    """hazard curve for a limit on the reliability, and for the report risk"""
    document: DocumentSection = DocumentSection()
    """who answers for the page of `rps report`"""


_KEYS: Any = {
    name: (key.kind, Field(None, description=key.meaning))
    for name, key in TOOL_KEYS.items()
}
_WITH_TOOLS = create_model(
    "WithTools", __base__=StudyParts, __cls_kwargs__=WITHOUT_SOURCE, **_KEYS
)


class StudyFile(_WITH_TOOLS, use_attribute_docstrings=True):
    """A study of rps: many points from one case."""

    analysis: Analysis = "timehistory"
    """what is done at every point"""
    vary: Axes = ()
    """axes of a product; the keys of one axis go together, with `labels:` as names
    for readers, one a value"""
    linked: Linked = Field(
        {},
        description="further keys as sums of those of an axis, {key: factor, plus: constant}",
    )
    sample: SampleSection | None = None
    """uncertain parameters; one more axis"""
    reports: Annotated[tuple[Any, ...], A_LIST] = ()
    """names of reports, or `name: {option: value}`"""
