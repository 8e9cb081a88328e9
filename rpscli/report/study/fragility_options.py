"""Options of fragilities: limit states, intensity measures, dispersion beside records."""

from __future__ import annotations

from typing import Annotated, Any, NamedTuple

import numpy as np
from pydantic import Field, StrictBool, create_model

from rpscli.analyses.result_quantities import LIMITED
from rpscli.case.conditions import LIMITS
from rpscli.case.schema.case_file import Time
from rpscli.case.schema.fields import DampingRatio, Quantity, Section, Whole
from rpscli.case.schema.limits import described
from rpscli.case.schema.scale_to import MeasureName
from rpscli.case.study.reports import ReportOptions, VariedKeys
from rpscli.case.study.schema import Option, PositiveNumber, PositiveNumbers, Seed
from rpscli.records.measures import MEASURES
from rpscli.sweep.points import StudyPoints
from rpscli.sweep.statistics.fractiles import CONFIDENCE

_THRESHOLDS: Any = {
    quantity.name: (PositiveNumbers | None, Field(None, description=described(quantity)))
    for quantity in LIMITED
}


class LimitStates(create_model("LimitStates", __base__=Section, **_THRESHOLDS)):  # type: ignore[misc]
    """Limit states of a fragility; overturning exceeds every one of them."""

    overturning: StrictBool = Field(
        default=True, description="whether overturning is a limit state itself"
    )

    @property
    def states(self) -> list[LimitState]:
        """The limit states that a study asks for."""
        found = [
            LimitState(quantity.name, threshold)
            for quantity in LIMITED
            for threshold in getattr(self, quantity.name) or ()
        ]
        return [*found, *[LimitState("overturning", None)] * self.overturning]


class LimitState(NamedTuple):
    """Exceeded where a result is beyond a threshold; every
    overturned point exceeds it.
    """

    result: str
    threshold: float | None

    @property
    def label(self) -> str:
        """The state in words."""
        if self.threshold is None:
            return self.result
        sign = "<" if LIMITS[self.result].from_below else ">"
        return f"{self.result} {sign} {self.threshold:g}"

    @property
    def title(self) -> str:
        """The state in the words of the results, with its unit."""
        if (known := LIMITS.get(self.result)) is None:
            return self.label
        return f"{self.label.replace(self.result, known.label, 1)} {known.unit}".removesuffix(
            " -"
        )


class MeasureOptions(ReportOptions):
    """Options of reports that need an intensity measure."""

    measure: MeasureName | None = Field(
        None, description="the one that the study scales to by default, else PGV"
    )
    period: Time | None = Field(
        None, description="of Sa, AvgSa or FIV3; T1 of each system by default"
    )
    damping: DampingRatio = Field(0.05, description="of Sa, AvgSa or Housner")


Dispersion = Annotated[
    float, Quantity(symbol="standard deviation of ln", at_least=0, at_most=2)
]


class DispersionSection(Section):
    """Uncertainties in quadrature with the scatter of records
    (FEMA P695, section 7.3.4).
    """

    record_to_record: Dispersion | None = None
    """in place of the beta of the fit, such as 0.4"""
    design_requirements: Dispersion = 0.0
    """beta_DR, 0.1 (superior) to 0.5 (poor)"""
    test_data: Dispersion = 0.0
    """beta_TD, 0.1 to 0.5"""
    modelling: Dispersion = 0.0
    """beta_MDL, 0.1 to 0.5"""

    @property
    def given(self) -> list[tuple[str, float]]:
        """Those that the study gives."""
        return [(key, value) for key, value in self if value]

    def total(self, beta: Any) -> Any:
        """beta_TOT from that of records."""
        own = (
            beta if self.record_to_record is None else self.record_to_record + 0.0 * beta
        )
        return np.sqrt(
            own**2 + self.design_requirements**2 + self.test_data**2 + self.modelling**2
        )


class FragilityOptions(MeasureOptions):
    """Probability of exceeding a limit state against an intensity measure."""

    resamples: Annotated[int, Whole(0, 10_000)] = Field(
        400, description="bootstrap samples of the records for the bands; 0 = none"
    )
    confidence: Annotated[float, Quantity(above=0, below=1)] = Field(
        CONFIDENCE, description="probability inside the bands, for the choice of records"
    )
    seed: Seed = Field(1, description="of the bootstrap")
    limits: LimitStates = Field(LimitStates(), description="limit states")
    series: VariedKeys | None = Field(
        None, description="varied keys, one curve for each value"
    )
    panels: VariedKeys = Field(
        (), description="varied keys, one panel for each value and limit state"
    )
    dispersion: DispersionSection = Field(
        DispersionSection(), description="uncertainty beyond the records"
    )
    at: dict[str, Option] = Field(
        {},
        description="intensities by name, {MCE: 0.6 m/s}: collapse margin ratios, probabilities",
    )
    spectral_shape: PositiveNumber = Field(
        1.0,
        description="factor SSF of FEMA P695 on collapse margin ratios, made for Sa(T1)",
    )

    @property
    def results(self) -> list[str]:
        """Results that the limit states are about."""
        return [limit.result for limit in self.limits.states]

    def intensities(self, layout: StudyPoints) -> dict[str, float]:
        """The intensities under `at` in SI; raises pydantic's error if one is none."""
        scaled = layout.plan.measure
        measure = self.measure or (scaled.measure if scaled else "PGV")
        bounds = Quantity(MEASURES[measure].unit, symbol=measure, above=0)
        return {name: float(bounds.read(value)) for name, value in self.at.items()}
