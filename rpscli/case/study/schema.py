"""The study file as pydantic models: every key, its meaning and bounds.

What `base` and the varied keys hold belongs to the case format and is checked as a case; rules
that join several keys stand in `rules`.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Discriminator, Field, Tag

from rpscli.case.schema.case_file import FORMAT_VERSION, PositiveRatio, Time
from rpscli.case.schema.fields import Text, Whole
from rpscli.case.schema.limits import LimitsSection
from rpscli.case.schema.section import Section
from rpscli.case.study.fields import (
    DampingRatio,
    MeasuredValues,
    Number,
    Numbers,
    Seed,
    Share,
    ValueRange,
)
from rpscli.records.measures.measure import Measure

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
