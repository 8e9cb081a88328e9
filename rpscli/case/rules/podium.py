"""What the keys of `podium` must be together, and whether the structure comes down again."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import get_args

from rpscli.case.build import Podium, Shape, overturning_limit
from rpscli.case.rules.partial_case import (
    BEARING,
    CONTACT,
    DEVICES,
    IMPACT,
    PODIUM,
    PartialCase,
)
from rpscli.case.schema.case_file import (
    DEVICE_KEYS,
    AnalysisSection,
    DeviceSection,
    ImpactSection,
)
from rpscli.case.text.document import Document, Fault, Path
from rpscli.errors import listed
from rpscli.model.bearing import Bearing
from rpscli.model.devices import DEVICES as LAWS
from rpscli.model.impact import ImpactKind, ImpactLaw
from rpscli.model.podium import MOST_DEVICES

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
        for name, meaning in MEANINGS.items():
            yield from case.missing((*BEARING, name), meaning)
    elif case.is_mapping(BEARING):
        names = "semi_diagonal, slenderness, wedge_slenderness and curvature_ratio"
        text = f"podium.bearing has no shape: give {names}, or dimensions"
        yield Fault(BEARING, text, at_key=True, needs=((*BEARING, "semi_diagonal"), DIMENSIONS))
    bearing = case.bearing
    if bearing and not (ratios and case.has(DIMENSIONS)):
        sizes = bearing.dimensions
        path = (*DIMENSIONS, "wedge_width") if sizes else (*BEARING, "wedge_slenderness")
        if sizes.radius if sizes else bearing.curvature_ratio:
            meaning = "2B', across the outer edges of the arcs" if sizes else "tan(alpha') = B'/H"
            yield from case.missing(path, f"{meaning}; only flat ends need none")
        if case.shape and case.shape.slenderness == 0.0 and case.shape.curvature_ratio <= 0.5:
            yield _small_sphere(case, case.shape)
        elif case.shape and case.shape.curvature_ratio:
            yield from _arc(case, case.shape)


def _small_sphere(case: PartialCase, shape: Shape) -> Fault:
    """Spherical ends: the column stands as long as its centre is below that of the arc."""
    sizes = case.bearing.dimensions if case.bearing else None
    path, flat = (*BEARING, "curvature_ratio"), "slenderness"
    value, least = f"{shape.curvature_ratio:g}", "0.5"
    if sizes:
        path, value, flat = (*DIMENSIONS, "radius"), f"{sizes.radius:g} m", "width"
        least = f"{0.5 * sizes.height:g} m, half the height,"
    return Fault(
        path,
        f"{'.'.join(map(str, path))} = {value} must be > {least} with {flat}: 0: without a flat"
        " part a smaller arc does not hold the columns upright; use a larger one, or a"
        f" {flat} above 0",
    )


def _arc(case: PartialCase, shape: Shape) -> Iterator[Fault]:
    """0 <= sin(beta) = (tan alpha' - tan alpha)/(2 rho) <= 1 (Theory (1.1))."""
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
    angle = math.tan(math.radians(flat)) if limit == "slenderness" and 1.0 < flat < 45.0 else 0.0
    degrees = f"; slenderness is tan(alpha), of {flat:g} degrees {angle:.4f}" if angle else ""
    return Fault(path, f"{text}: the arcs lie outside the flat part{degrees}")


def impact_rules(case: PartialCase) -> Iterator[Fault]:
    """The law `value` has a restitution; the other laws give one, of which `loss` takes a part."""
    law, path = case.document.at((*IMPACT, "law")), (*IMPACT, "restitution")
    if law == "value" or case.document.at(IMPACT) == "value":
        yield from case.missing(path, "law value needs one, as in 0.92")
        if case.document.has((*IMPACT, "loss")) and case.document.at((*IMPACT, "loss")) != 1.0:
            text = (
                "podium.impact.loss does not go with law value: a measured restitution includes"
                " the loss; remove it, or scale the restitution by factor"
            )
            yield Fault((*IMPACT, "loss"), text, at_key=True)
    elif case.document.has(path):
        if law not in get_args(ImpactKind):
            law = ImpactSection().law
        yield Fault(
            path,
            f"podium.impact.restitution does not go with law {law}{case.where((*IMPACT, 'law'))},"
            " which gives its own; remove it, write law: value, or change the law by loss or"
            " factor",
            at_key=True,
        )


def contact_rules(case: PartialCase) -> Iterator[Fault]:
    """Compliant ends come down without bounces that could be left out."""
    if case.document.at((*CONTACT, "kind")) in ("plane", "edges"):
        path: Path = ("analysis", "recontact_tolerance")
        default = AnalysisSection().recontact_tolerance  # of a case that was written out whole
        if case.document.has(path) and case.document.at(path) != default:
            text = (
                "analysis.recontact_tolerance has no effect with podium.contact"
                f"{case.where((*CONTACT, 'kind'))}: compliant ends do not bounce; remove it"
            )
            yield Fault(path, text, at_key=True)


def above(x: float, digits: int = 4) -> str:
    """A number not below x, of few digits, to be proposed as a lower bound."""
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


def overturning_rule(bearing: Bearing, analysis: AnalysisSection) -> Iterator[Fault]:
    """A structure must have overturned where the model ends."""
    limit, critical = analysis.overturning_limit, bearing.critical_rotation
    if limit * critical > bearing.largest_rotation:
        yield Fault(
            ("analysis", "overturning_limit"),
            f"analysis.overturning_limit = {limit:g} times theta_cr = {critical:.6g} rad must not"
            f" exceed {bearing.largest_rotation:.6g} rad, where the columns lie down and the model"
            f" ends; use at most {below(bearing.largest_rotation / critical)}",
        )


def release_rule(bearing: Bearing, analysis: AnalysisSection) -> Iterator[Fault]:
    """A structure that is let go from a rotation must not have overturned already."""
    limit = overturning_limit(analysis, bearing) * bearing.critical_rotation
    if abs(analysis.initial_rotation) >= limit:
        yield Fault(
            ("analysis", "initial_rotation"),
            f"analysis.initial_rotation = {analysis.initial_rotation:g} rad must stay below the"
            " overturning limit,"
            f" {limit:.6g} rad (overturning_limit * theta_cr, or less); use less than"
            f" {below(limit)}",
        )


def restitution_rule(podium: Podium, document: Document) -> Iterator[Fault]:
    """The impact law sends the columns to their other edge: 0 < e <= 1 (Theory, section 4)."""
    column, law = podium.bearing, podium.impact_law
    e = law.ratio(column, podium.gamma, podium.eta)
    if column.is_spherical:
        if e != 1.0:
            yield Fault(
                IMPACT,
                "podium.impact: columns without a flat part roll through the upright position and"
                " have no impact; remove restitution and factor",
                at_key=True,
            )
        return
    if e > 1.0:
        yield Fault(
            (*IMPACT, "factor"),
            f"podium.impact.factor = {law.factor:g} gives the restitution {e:.4g}, which must be"
            f" <= 1; use a factor of at most {below(law.factor / e)}",
        )
    if e <= 0.0:
        widest = largest_slenderness(law, column.inertia_ratio, podium.gamma, podium.eta)
        lost = "" if law.loss == 1.0 else f", loss {law.loss:g}"
        name = "dimensions" if document.has((*BEARING, "dimensions")) else "slenderness"
        under, lighter = "", ""
        if law.kind == "flexible" and podium.eta > 0.0:
            beam, sin2 = 4.0 * podium.gamma, math.sin(column.alpha) ** 2
            most = (column.inertia_ratio + beam) / sin2 - 2.0 * law.loss * (1.0 + beam)
            most /= (2.0 * law.loss - 1.0) * beam
            under = f" under a building of {podium.eta:g} times the cap beam's mass"
            lighter = (
                f", a building of less than {below(most)} times that mass" if most > 0.0 else ""
            )
        yield Fault(
            (*BEARING, name),
            f"podium.bearing: the slenderness tan(alpha) = {column.slenderness:g}{under} gives the"
            f" restitution {e:.4g} (impact law {law.kind}{lost}), which must be > 0 for the columns"
            f" to pass to their other edge; use less than {below(widest)}{lighter}, a part of"
            " the loss with impact: {loss: 0.5}, or a measured value with"
            " impact: {law: value, restitution: ...}",
        )


def largest_slenderness(law: ImpactLaw, inertia_ratio: float, gamma: float, eta: float) -> float:
    """tan(alpha) at which a law's restitution is 0 (Theory (4.6), (4.8)); Housner: sin^2 = 2/3."""
    beam, floors = 4.0 * gamma, 4.0 * gamma * eta
    # kappa (1 - e_edge) = 1 with 1 - e_edge = 2 sin^2 (1 + beam + floors)/(Io + ...)
    if law.kind == "rigid":
        sin2 = (inertia_ratio + beam + floors) / (2.0 * law.loss * (1.0 + beam + floors))
    else:
        sin2 = (inertia_ratio + beam) / (2.0 * law.loss * (1.0 + beam + floors) - floors)
    return math.sqrt(sin2 / (1.0 - sin2)) if sin2 < 1.0 else math.inf


def devices_rules(case: PartialCase) -> Iterator[Fault]:
    """Each device has the keys of its kind, and there are not too many."""
    written = case.document.at(DEVICES)
    devices = written if isinstance(written, list) else []
    if len(devices) > MOST_DEVICES:
        yield Fault(
            DEVICES,
            f"podium.devices has {len(devices)} devices, at most {MOST_DEVICES} are followed;"
            " write equal ones as one, with the sum of their forces and stiffnesses",
            at_key=True,
        )
    for index, device in enumerate(devices):
        if isinstance(device, dict) and str(device.get("kind")) in DEVICE_KEYS:
            yield from _keys_of(case, (*DEVICES, index), device["kind"])
            yield from _yield_force(case, (*DEVICES, index), device)
            if device["kind"] == "tendon" and case.shape and case.shape.slenderness == 0.0:
                text = (
                    f"podium.devices.{index}: tendons are not followed in columns without a flat"
                    " part; leave it out, or give the columns a flat part above 0"
                )
                yield Fault((*DEVICES, index), text, at_key=True)
    named = [str(isinstance(device, dict) and device.get("kind")) for device in devices]
    of_columns = [i for i, kind in enumerate(named) if kind in LAWS and LAWS[kind].in_each_column()]
    columns = (*PODIUM, "columns")
    if of_columns and not case.has(columns):
        yield Fault(
            (*DEVICES, of_columns[0]),
            f"podium.devices.{of_columns[0]} is in each column, but podium.columns, their"
            " number, is missing",
            needs=(columns,),
        )


def _keys_of(case: PartialCase, path: Path, kind: str) -> Iterator[Fault]:
    """The keys that a kind needs, and none of another kind."""
    needed, optional = DEVICE_KEYS[kind]
    name = ".".join(map(str, path))
    for key in needed:
        yield from case.missing((*path, key), DeviceSection.model_fields[key].description or "")
    for key in case.written(path, *DeviceSection.model_fields):
        if key not in ("kind", *needed, *optional):
            known = listed((*needed, *optional), "and")
            text = f"{name}.{key} is not a key of kind: {kind}, which has {known}; remove it"
            yield Fault((*path, key), text, at_key=True)


def _yield_force(case: PartialCase, path: Path, device: dict[str, object]) -> Iterator[Fault]:
    """A tendon carries its prestress."""
    read = case.device(path[-1]) if device["kind"] == "tendon" else None
    if read and read.yield_force and read.prestress and read.yield_force <= read.prestress:
        name = ".".join(map(str, path))
        yield Fault(
            (*path, "yield_force"),
            f"{name}.yield_force = {device['yield_force']} must be > prestress ="
            f" {device['prestress']}{case.where((*path, 'prestress'))}; use a lower prestress, or"
            " leave yield_force out for a tendon that never yields",
        )
