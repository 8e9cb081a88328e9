"""The design file as pydantic models: what a study says of a case, and what is looked for in it."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, PlainValidator, ValidationError, WithJsonSchema

from rpscli.case.schema.fields import Quantity, Whole, first_fault, refuse
from rpscli.case.schema.limits import Fractile
from rpscli.case.schema.section import Section
from rpscli.case.study.fields import Seed
from rpscli.case.study.schema import StudyParts
from rpscli.case.text.faults import shown

PLUS = "plus"
"""What is added to a linear sum."""


class Term(Section):
    """One term of what is to be least."""

    times: Annotated[float, Quantity()] = Field(1.0, description="factor, in SI units")
    fractile: Fractile = Field(
        0.5, description="of a result over the records; its median by default"
    )


Aim = dict[str, Term]
"""A linear sum of results and keys, by their names."""


def _aims(value: object) -> tuple[Aim, ...]:
    """One sum, or two whose front is looked for."""
    several = value if isinstance(value, list) else [value]
    if not 1 <= len(several) <= 2:
        refuse("must be one aim, or a list of two")
    return tuple(_aim(item) for item in several)


def _aim(value: object) -> Aim:
    """A name alone, or a sum."""
    if isinstance(value, str) and value.strip():
        return {value: Term.model_validate({})}
    if not isinstance(value, dict) or not value:
        refuse(
            f"has {shown(value)}, which must be a key or a result, or a sum such as"
            " {max_base_shear: 1e-6, podium.bearing.dimensions.width: 0.5}"
        )
    return {str(name): _term(name, given) for name, given in value.items()}


def _term(name: object, given: object) -> Term:
    written = given if isinstance(given, dict) else {"times": given}
    if isinstance(given, Term):
        return given
    try:
        return Term.model_validate(written)
    except ValidationError as error:
        refuse(f"has {name}: {shown(given)}, whose {first_fault(error)}")


_SUM = {"type": "object", "minProperties": 1}
_ONE_AIM = {
    "anyOf": [
        {"type": "string", "minLength": 1},
        _SUM | {"additionalProperties": {"anyOf": [{"type": "number"}, Term.model_json_schema()]}},
    ]
}
_BOUND = {"type": ["number", "string"]}

Bounds = Annotated[
    Any, WithJsonSchema({"type": "array", "items": _BOUND, "minItems": 2, "maxItems": 2})
]
"""Two values, which the task reads in the unit of their key."""
Aims = Annotated[
    tuple[Aim, ...],
    PlainValidator(_aims),
    WithJsonSchema(
        {"anyOf": [*_ONE_AIM["anyOf"], {"type": "array", "items": _ONE_AIM, "maxItems": 2}]}
    ),
]


class SearchSection(Section):
    """How many designs are looked at; what is left out follows from the number of unknowns."""

    first: Annotated[int, Whole(4, 65_536)] | None = Field(
        None, description="designs of the first, even sample"
    )
    most: Annotated[int, Whole(4, 65_536)] | None = Field(
        None, description="designs in all; four times the first ones by default"
    )
    resolution: Annotated[float, Quantity(above=0, below=1)] = Field(
        0.005, description="distance to which designs close in, as a share of each range"
    )
    resamples: Annotated[int, Whole(0, 10_000)] = Field(
        500, description="bootstrap samples of the records; 0 = none"
    )
    seed: Seed = Field(1, description="of the sample and the bootstrap")


class ConfirmSection(Section):
    """Motions that the search does not see."""

    records: tuple[Any, ...] | None = Field(None, description="record sources, as in a study")
    share: Annotated[float, Quantity(above=0, below=1)] | None = Field(
        None, description="share of the design's own records that is held out, in place of them"
    )
    seed: Seed = Field(1, description="of the draw of what is held out")


class DesignFile(StudyParts):
    """A design: the values of some keys of a case that meet the limits and make an aim least."""

    find: dict[str, Bounds] = Field(
        description="dotted case keys with [least, largest]: what may change"
    )
    ties: dict[str, dict[str, float]] = Field(
        {}, description="further keys as linear sums of these, {key: factor, plus: constant}"
    )
    least: Aims = Field(
        description="what is to be least: a result, a key, or a sum of them; two for their front"
    )
    confirm: ConfirmSection | None = Field(None, description="motions to confirm the design with")
    search: SearchSection = Field(SearchSection(), description="how many designs are looked at")
