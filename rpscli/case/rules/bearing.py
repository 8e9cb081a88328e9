"""What the keys of `podium.bearing` and `podium.impact` must be together."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import get_args

from rpscli.case.build import Shape
from rpscli.case.rules.partial_case import BEARING, IMPACT, PartialCase
from rpscli.case.schema.case_file import BearingSection, ImpactSection
from rpscli.case.text.faults import Fault, Path
from rpscli.model.impact import ImpactKind

RATIOS = ("semi_diagonal", "slenderness", "wedge_slenderness", "curvature_ratio")
MEANINGS = {
    "semi_diagonal": "R = sqrt(H^2 + B^2), as in '1.5 m'",
    "slenderness": "tan(alpha) = B/H, as in 0.15",
    "curvature_ratio": "rho = r/2H, as in 0.5; 0 for flat ends, or the word critical",
}
DIMENSIONS: Path = (*BEARING, "dimensions")


def bearing_rules(case: PartialCase) -> Iterator[Fault]:
    """One description of the column, complete and possible."""
    ratios = case.present(BEARING, *RATIOS)
    if case.has(DIMENSIONS):
        for name in case.written(BEARING, *RATIOS):
            yield Fault(
                (*BEARING, name),
                f"podium.bearing.{name} and podium.bearing.dimensions{case.where(DIMENSIONS)}"
                " both describe the column; keep the ratios or the dimensions",
                at_key=True,
            )
    elif ratios:
        yield from _missing_ratios(case)
    elif case.is_mapping(BEARING):
        names = "semi_diagonal, slenderness, wedge_slenderness and curvature_ratio"
        text = f"podium.bearing has no shape: give {names}, or dimensions"
        yield Fault(BEARING, text, at_key=True, needs=((*BEARING, "semi_diagonal"), DIMENSIONS))
    bearing = case.bearing
    if bearing and not (ratios and case.has(DIMENSIONS)):
        yield from _missing_wedge(case, bearing)
        if case.shape and case.shape.curvature_ratio:
            yield from _arc(case, case.shape)


def _missing_ratios(case: PartialCase) -> Iterator[Fault]:
    for name, meaning in MEANINGS.items():
        path = (*BEARING, name)
        if not case.has(path):
            text = f"podium.bearing.{name} is missing: {meaning}"
            yield Fault(path, text, at_key=True, needs=(path,))


def _missing_wedge(case: PartialCase, bearing: BearingSection) -> Iterator[Fault]:
    sizes = bearing.dimensions
    curved = sizes.radius if sizes else bearing.curvature_ratio
    path = (*DIMENSIONS, "wedge_width") if sizes else (*BEARING, "wedge_slenderness")
    if curved and not case.has(path):
        meaning = "2B', across the outer edges of the arcs" if sizes else "tan(alpha') = B'/H"
        name = f"podium.bearing.{'dimensions.wedge_width' if sizes else 'wedge_slenderness'}"
        text = f"{name} is missing: {meaning}; only flat ends do without"
        yield Fault(path, text, at_key=True, needs=(path,))


def _arc(case: PartialCase, shape: Shape) -> Iterator[Fault]:
    """0 <= sin(beta) = (tan alpha' - tan alpha)/(2 rho) <= 1 (Theory, section 1)."""
    rise = shape.wedge_slenderness - shape.slenderness
    sizes = case.bearing.dimensions if case.bearing else None
    if rise < 0.0:
        yield _narrow_wedge(case, shape)
    elif rise <= 2.0 * shape.curvature_ratio:
        return
    elif sizes:
        yield Fault(
            (*DIMENSIONS, "radius"),
            f"podium.bearing.dimensions.radius = {sizes.radius:g} m is too small an arc to reach"
            f" the wedge's edge; use a radius of at least {above(0.5 * rise * sizes.height)} m or"
            f" a wedge_width of at most {below(sizes.width + 2.0 * sizes.radius)} m",
        )
    elif case.bearing and case.bearing.curvature_ratio == "critical":
        yield Fault(
            (*BEARING, "wedge_slenderness"),
            f"podium.bearing.wedge_slenderness = {shape.wedge_slenderness:g} must be <= 1 with"
            " curvature_ratio: critical: the arc would turn by more than 90 degrees",
        )
    else:
        widest = shape.slenderness + 2.0 * shape.curvature_ratio
        yield Fault(
            (*BEARING, "curvature_ratio"),
            f"podium.bearing.curvature_ratio = {shape.curvature_ratio:g} is too small an arc to"
            f" reach the wedge's edge (sin(beta) = {0.5 * rise / shape.curvature_ratio:.3g} must"
            f" be <= 1); use a curvature_ratio of at least {above(0.5 * rise)} or a"
            f" wedge_slenderness of at most {below(widest)}",
        )


def _narrow_wedge(case: PartialCase, shape: Shape) -> Fault:
    if case.has(DIMENSIONS):
        path, name, limit = (*DIMENSIONS, "wedge_width"), "dimensions.wedge_width", "width"
        wedge, flat = (case.document.at((*DIMENSIONS, n)) for n in ("wedge_width", "width"))
    else:
        path, name, limit = (*BEARING, "wedge_slenderness"), "wedge_slenderness", "slenderness"
        wedge, flat = shape.wedge_slenderness, shape.slenderness
    where = case.where((*path[:-1], limit))
    text = f"podium.bearing.{name} = {wedge} must be >= {limit} = {flat}{where}"
    return Fault(path, f"{text}: the arcs lie outside the flat part")


def impact_rules(case: PartialCase) -> Iterator[Fault]:
    """The law `value` has a restitution; the other laws give one, of which `loss` takes a part."""
    law, path = case.document.at((*IMPACT, "law")), (*IMPACT, "restitution")
    if law == "value" or case.document.at(IMPACT) == "value":
        if not case.has(path):
            text = "podium.impact.restitution is missing: law value needs one, as in 0.92"
            yield Fault(path, text, at_key=True, needs=(path,))
        if case.document.has((*IMPACT, "loss")) and case.document.at((*IMPACT, "loss")) != 1.0:
            text = (
                "podium.impact.loss does not go with law value: a measured restitution holds what"
                " was lost; take it out, or scale the restitution by factor"
            )
            yield Fault((*IMPACT, "loss"), text, at_key=True)
    elif case.document.has(path):
        if law not in get_args(ImpactKind):
            law = ImpactSection().law
        yield Fault(
            path,
            f"podium.impact.restitution does not go with law {law}{case.where((*IMPACT, 'law'))},"
            " which gives its own; take it out, write law: value, or change the law by loss or"
            " factor",
            at_key=True,
        )


def above(x: float, digits: int = 4) -> str:
    """A number not below x, of few digits, to be proposed as a lower bound.

    >>> above(0.0750123), above(0.075)
    ('0.07502', '0.075')
    """
    return f"{_rounded(x, digits, math.ceil):g}"


def below(x: float, digits: int = 4) -> str:
    """A number not above x, of few digits, to be proposed as an upper bound."""
    return f"{_rounded(x, digits, math.floor):g}"


def _rounded(x: float, digits: int, direction: Callable[[float], int]) -> float:
    decimals = digits - 1 - math.floor(math.log10(x))
    nearest = round(x, decimals)  # keeps 0.075 from becoming 0.07501 by rounding noise
    if math.isclose(nearest, x, rel_tol=1e-12):
        return nearest
    return direction(x * 10.0**decimals) / 10.0**decimals
