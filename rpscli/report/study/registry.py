"""All kinds of report by the names that studies call them."""

from __future__ import annotations

from typing import Any

from rpscli.report.study import (
    comparison,
    contrast,
    demand,
    demand_sample,
    directions,
    floor_spectra,
    fragility,
    ida,
    lines,
    overturning,
    overturning_spectrum,
    risk,
    rotation,
    storey_shear,
)
from rpscli.report.study.report import Report

REPORTS: dict[str, Report[Any, Any]] = {
    "overturning": overturning.REPORT,
    "rotation": rotation.REPORT,
    "contrast": contrast.REPORT,
    "demand": demand.REPORT,
    "demand_sample": demand_sample.REPORT,
    "directions": directions.REPORT,
    "storey_shear": storey_shear.REPORT,
    "floor_spectra": floor_spectra.REPORT,
    "fragility": fragility.REPORT,
    "risk": risk.REPORT,
    "ida": ida.REPORT,
    "overturning_spectrum": overturning_spectrum.REPORT,
    "comparison": comparison.REPORT,
    "lines": lines.REPORT,
}
