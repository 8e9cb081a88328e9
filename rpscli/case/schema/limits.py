"""Acceptance limits as pydantic models: one key for each result of the
table that may be limited.

A limit is a number, which every record must keep; or a number that a share of the records
may exceed, `{at_most: 0.5, share: 0.1}`; or one for a fractile, `{at_most: 0.5, fractile:
0.84}`; or one for the mean of the records, `{at_most: 0.5, of: mean}`. Results of which
small values are bad have `at_least` in place of `at_most`. A demand may be judged times a
`factor`, as EN 1998-1, 10.3(2)P asks of displacements: `{at_most: 60 mm, factor: 1.2}`.
"""

from __future__ import annotations

from functools import cache
from typing import Annotated, Any, Literal, Self

from pydantic import Discriminator, Field, Tag, create_model, model_validator

from rpscli.analyses.result_quantities import LIMITED, ResultQuantity
from rpscli.case.schema.fields import PLAIN, Quantity, Section, refuse
from rpscli.units import KINDS

Admissible = Annotated[float, Quantity(at_least=0, below=1, remedy="10 % is 0.1")]
Magnification = Annotated[
    float, Quantity(symbol="gamma_x", at_least=1, remedy="EN 1998-1 recommends 1.2")
]
Fractile = Annotated[float, Quantity(above=0, below=1, remedy="84 % is 0.84")]


FACTOR = (
    "the demand is judged times this factor; 1 by default. EN 1998-1, 10.3(2)P: gamma_x on"
    " displacements of isolating units, recommended 1.2 for buildings"
)
WITHOUT_SOURCE = {"use_attribute_docstrings": False}
"""Option of models that no class statement defines: looking for
their source takes long."""


class LimitRule(Section):
    """A limit for the records of a study together; a single
    history must keep it anyway.
    """

    share: Admissible | None = None
    """share of the records that may exceed the limit; 0 by default"""
    fractile: Fractile | None = None
    """fractile of the demand that must meet the limit, in place of a share"""
    of: Literal["mean"] | None = None
    """mean: the mean of the maxima must meet the limit; of fewer than 7 recordings the
    largest (EN 1998-1)"""

    @model_validator(mode="after")
    def _one_rule(self) -> Self:
        rules = self.share, self.fractile, self.of
        if sum(rule is not None for rule in rules) > 1:
            refuse(
                "must have a share or a fractile or `of: mean`, only one of them; remove the rest"
            )
        return self


def _limit(quantity: ResultQuantity) -> Any:
    """A number, or a mapping with more to say."""
    unit = quantity.unit if quantity.unit in KINDS else PLAIN
    zero = quantity.whole or quantity.from_below
    return _limit_of(unit, zero, "at_least" if quantity.from_below else "at_most")


@cache
def _limit_of(unit: str, zero: bool, key: str) -> Any:  # noqa: FBT001 -- whether 0 is admissible
    number = Annotated[
        float, Quantity(unit, at_least=0) if zero else Quantity(unit, above=0)
    ]
    fields: Any = {key: (number, Field(description="admissible value"))}
    if key == "at_most":
        fields["factor"] = Magnification | None, Field(None, description=FACTOR)
    rule = create_model(
        f"Limit_{unit}_{key}{zero:d}",
        __base__=LimitRule,
        __cls_kwargs__=WITHOUT_SOURCE,
        **fields,
    )
    form = Discriminator(
        lambda of: "rule" if isinstance(of, dict | LimitRule) else "number"
    )
    return Annotated[
        Annotated[rule, Tag("rule")] | Annotated[number, Tag("number")], form
    ]


def described(quantity: ResultQuantity) -> str:
    """Description of a limit, for schemas."""
    side = ", which must be at least this large" * quantity.from_below
    return f"{quantity.label}{f': {quantity.meaning}' * bool(quantity.meaning)}{side}"


_FIELDS: Any = {
    quantity.name: (_limit(quantity) | None, Field(None, description=described(quantity)))
    for quantity in LIMITED
}
_LIMITS = create_model(
    "Limits", __base__=Section, __cls_kwargs__=WITHOUT_SOURCE, **_FIELDS
)


class LimitsSection(_LIMITS, use_attribute_docstrings=True):
    """Acceptance limits."""

    overturning: Admissible | None = None
    """share of the records that may overturn; 0 = none"""
    uplift: Admissible | None = None
    """share of the records that may uplift; 0 = none"""


class StudyLimits(LimitsSection):
    """Limits of studies and designs, which may be on the
    reliability; it needs a `hazard`.
    """

    annual_rate: Annotated[float, Quantity(symbol="1/year", above=0)] | None = None
    """how often a year the structure may overturn, from shares at all intensities"""
    probability_in_50_years: (
        Annotated[float, Quantity(above=0, below=1, remedy="1 % is 0.01")] | None
    ) = None
    """probability of overturning in 50 years, in place of the rate"""

    @model_validator(mode="after")
    def _one_of_both(self) -> Self:
        if self.annual_rate is not None and self.probability_in_50_years is not None:
            refuse("must have annual_rate or probability_in_50_years, not both")
        return self
