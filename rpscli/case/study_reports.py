"""The options of each report of a study, as pydantic models."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, StrictBool

from rpscli.case.fields import Quantity, Text, Whole
from rpscli.case.schema import Section, Time
from rpscli.case.study_fields import DampingRatio, Keys, PositiveNumbers, Seed
from rpscli.case.study_schema import Measure


class ReportOptions(Section):
    """Options that every report has."""

    name: Text | None = Field(None, description="stem of its files; the report's kind by default")
    title: Text | None = Field(None, description="heading of the figure; the study's by default")


class OverturningOptions(ReportOptions):
    """Share of the points that overturn, as a table."""

    rows: Keys | None = Field(None, description="varied keys down the table; all but the columns'")
    columns: Keys | None = Field(None, description="varied keys across; those of the last axis")


class RotationOptions(ReportOptions):
    """Largest rotations of several systems against those of one, record by record."""

    key: Text | None = Field(None, description="varied key in which they differ; the last axis")
    reference: Any = Field(None, description="its value on the horizontal axis; the last one")
    panels: Keys | None = Field(None, description="varied keys, one panel for each value")


class DemandOptions(ReportOptions):
    """Base shear against rotation with its bilinear summary."""

    panels: Keys | None = Field(None, description="varied keys, one panel for each value")
    series: Keys | None = Field(None, description="varied keys, one colour for each value")


class StoreyShearOptions(ReportOptions):
    """Mean and largest storey shears against those on a fixed base."""

    panels: Keys | None = Field(None, description="varied keys, one panel for each value")


class MeasureOptions(ReportOptions):
    """Options of reports that need an intensity measure."""

    measure: Measure | None = Field(
        None, description="the one that the study scales to by default, else PGV"
    )
    period: Time | None = Field(None, description="of Sa; T1 of each system by default")
    damping: DampingRatio = Field(0.05, description="of Sa")


class LimitStates(Section):
    """Limit states of a fragility; overturning exceeds every one of them."""

    overturning: StrictBool = Field(
        default=True, description="whether overturning is a limit state itself"
    )
    rotation_ratio: PositiveNumbers | None = Field(None, description="max|theta|/theta_cr")
    drift_ratio: PositiveNumbers | None = Field(None, description="storey drift over storey height")
    base_shear_ratio: PositiveNumbers | None = Field(None, description="V_b/V_st")


class FragilityOptions(MeasureOptions):
    """Probability of exceeding a limit state against an intensity measure."""

    limits: LimitStates = Field(LimitStates(), description="limit states")
    series: Keys | None = Field(None, description="varied keys, one curve for each value")
    resamples: Annotated[int, Whole(0, 10_000)] = Field(
        200, description="bootstrap samples of the records for the bands; 0 = none"
    )
    confidence: Annotated[float, Quantity(above=0, below=1)] = Field(
        0.9, description="probability inside the bands"
    )
    seed: Seed = Field(1, description="of the bootstrap")


class IdaOptions(ReportOptions):
    """Incremental dynamic analysis: demand against intensity, with fractiles."""

    demand: Literal[
        "rotation_ratio",
        "max_rotation",
        "max_cap_beam_displacement",
        "base_shear_ratio",
        "drift_ratio",
    ] = Field("rotation_ratio", description="horizontal axis")
    panels: Keys | None = Field(None, description="varied keys, one panel for each value")


class SpectrumOptions(ReportOptions):
    """Overturning spectrum of pulses: amplitude over g tan(alpha) against frequency over p."""

    panels: Keys | None = Field(None, description="varied keys, one panel for each value")


class LinesOptions(ReportOptions):
    """Any result against a varied key, or one list of results against another."""

    x: Text = Field(description="a varied key, or a result that is a list")
    y: Keys = Field(description="results, such as rolling.frequency_ratio.0")
    dashed: Keys = Field((), description="results drawn dashed, as a comparison")
    series: Keys | None = Field(None, description="varied keys, one line for each value")
    panels: Keys | None = Field(None, description="varied keys, one panel for each value")
    upright: StrictBool = Field(default=False, description="draw x upwards, as floors are")
    x_label: Text | None = Field(None, description="in place of the name of x")
    y_label: Text | None = Field(None, description="in place of the name of y")


REPORTS: dict[str, type[ReportOptions]] = {
    "overturning": OverturningOptions,
    "rotation": RotationOptions,
    "demand": DemandOptions,
    "storey_shear": StoreyShearOptions,
    "fragility": FragilityOptions,
    "ida": IdaOptions,
    "overturning_spectrum": SpectrumOptions,
    "lines": LinesOptions,
}
"""The reports by name."""
