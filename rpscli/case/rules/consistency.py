"""Rules that join several keys of a case, each of which is valid in itself."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator

from rpscli.analyses.result_quantities import LIMITED
from rpscli.case.build import Masses, Shape, overturning_limit
from rpscli.case.schema.case_file import (
    DEVICE_KEYS,
    AcrossSection,
    AnalysisSection,
    CaseFile,
    DeviceSection,
    SuperstructureSection,
)
from rpscli.case.text.document import Document, Fault, Path, dotted, shown
from rpscli.errors import RecordError, listed
from rpscli.model.bearing import Bearing
from rpscli.model.devices import DEVICES as LAWS
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import MOST_DEVICES
from rpscli.records.source import Source

PODIUM: Path = ("podium",)
BEARING: Path = ("podium", "bearing")
DIMENSIONS: Path = (*BEARING, "dimensions")
IMPACT: Path = ("podium", "impact")
CONTACT: Path = ("podium", "contact")
DEVICES: Path = ("podium", "devices")
STOREYS: Path = ("superstructure", "storeys")
HEIGHT: Path = ("superstructure", "storey_height")

GAMMA, ETA = "cap_beam_mass_ratio", "superstructure_mass_ratio"
BEAM, COLUMN, COLUMNS = "cap_beam_mass", "column_mass", "columns"


def faults_between_keys(file: CaseFile, document: Document) -> Iterator[Fault]:
    """What is missing, said twice, or cannot be true together, short of what shapes imply."""
    for rule in (
        _superstructure, _masses, _bearing, _impact, _contact, _devices, _record, _limits, _plan,
    ):  # fmt: skip
        yield from rule(file, document)


def _missing(path: Path, meaning: str) -> Fault:
    return Fault(path, f"{dotted(path)} is missing: {meaning}", at_key=True)


def _given(section: object, names: Iterable[str]) -> list[str]:
    """Those of the optional keys of a section that are written."""
    return [name for name in names if getattr(section, name) is not None]


def _superstructure(file: CaseFile, document: Document) -> Iterator[Fault]:
    """A building needs masses, stiffness and damping, each given once."""
    section = file.superstructure
    storeys, damping = section.storeys, section.damping
    if not storeys:
        return
    if section.storey_mass is None:
        meaning = "floor mass, one value or a list from the bottom, as in '200 t'"
        yield _missing(("superstructure", "storey_mass"), meaning)
    if damping is None:
        meaning = "as in {ratio: 0.05, modes: [1, 2]} (Rayleigh) or {ratio: 0.05} (every mode)"
        yield _missing(("superstructure", "damping"), meaning)
    yield from _stiffness(section, ("superstructure",), storeys, document)
    if section.y is not None:
        yield from _stiffness(section.y, ("superstructure", "y"), storeys, document)
    # One storey takes [1, 2] as well: stiffness-proportional, so that a study can vary storeys.
    if damping and damping.modes and max(damping.modes) > max(storeys, 2):
        yield Fault(
            ("superstructure", "damping", "modes"),
            f"superstructure.damping.modes = {shown(damping.modes)} must be from 1 to"
            f" superstructure.storeys = {storeys}{document.where(STOREYS)}; a building has as many"
            " modes as storeys",
        )


def _stiffness(
    section: SuperstructureSection | AcrossSection, owner: Path, storeys: int, document: Document
) -> Iterator[Fault]:
    """Stiffnesses follow from a period or are given; lists have one value a storey."""
    whose = dotted(owner)
    if section.stiffness is None and section.period is None:
        text = f"{whose} has no stiffness: give period (with profile), or stiffness"
        yield Fault(owner, text, at_key=True)
    if section.stiffness is not None:
        for name in _given(section, ("period", "profile")):
            where = document.where((*owner, name))
            text = f"{whose}.stiffness and {whose}.{name}{where} both fix the storey stiffnesses"
            yield Fault((*owner, "stiffness"), f"{text}; keep one of them", at_key=True)
    for name in ("storey_mass", "storey_height", "stiffness"):
        values = getattr(section, name, None)
        if isinstance(values, tuple) and len(values) != storeys:
            yield Fault(
                (*owner, name),
                f"{whose}.{name} has {len(values)} values, but superstructure.storeys ="
                f" {storeys}{document.where(STOREYS)}; give one value a storey from the bottom,"
                " or a single value",
            )


def _masses(file: CaseFile, document: Document) -> Iterator[Fault]:
    """Cap beam and columns each have one mass."""
    podium = file.podium
    if not file.superstructure.storeys:
        yield from _masses_of_frame(file, document)
        return
    for what, names in {
        "the mass of the cap beam": (ETA, BEAM),
        "the mass of the columns": (GAMMA, COLUMN),
    }.items():
        given = _given(podium, names)
        if not given:
            text = f"podium leaves {what} open: give {listed(names)}"
            yield Fault(PODIUM, text, at_key=True)
        elif len(given) > 1:
            yield _twice(document, what, given)
    yield from _number_of_columns(file)
    for name in (GAMMA, BEAM):
        if getattr(podium, name) == 0.0:
            yield Fault(
                (*PODIUM, name),
                f"podium.{name} = 0 must be > 0: the superstructure{document.where(STOREYS)} stands"
                " on the cap beam; 0 is for free-standing columns, with"
                " superstructure.storeys: 0",
            )


def _masses_of_frame(file: CaseFile, document: Document) -> Iterator[Fault]:
    """Without a building two of three: beam mass, column mass, and their ratio."""
    podium, names = file.podium, (BEAM, GAMMA, COLUMN)
    given = _given(podium, names)
    if podium.superstructure_mass_ratio is not None:
        yield Fault(
            (*PODIUM, ETA),
            f"podium.{ETA} has no meaning with superstructure.storeys = 0{document.where(STOREYS)};"
            f" give podium.{BEAM} instead",
            at_key=True,
        )
    elif len(given) > 2:
        yield _twice(document, "the masses of cap beam and columns", given)
    elif podium.without_cap_beam and (podium.cap_beam_mass_ratio or podium.cap_beam_mass):
        yield Fault(
            (*PODIUM, BEAM),
            f"podium.{BEAM} and podium.{GAMMA}{document.where((*PODIUM, GAMMA))} contradict each"
            " other: one says that there is no cap beam; give column_mass instead of one of them",
        )
    elif podium.without_cap_beam:
        if podium.column_mass is None:
            yield _missing((*PODIUM, COLUMN), "without a cap beam it is the only mass")
    else:
        if len(given) < 2:
            others = listed(name for name in names if name not in given)
            text = "podium leaves the masses of cap beam and columns open: give"
            text += f" {'one' if given else 'two'} of {others} (column_mass with columns)"
            yield Fault(PODIUM, text, at_key=True)
        yield from _number_of_columns(file)


def _number_of_columns(file: CaseFile) -> Iterator[Fault]:
    if file.podium.column_mass is not None and file.podium.columns is None:
        yield _missing((*PODIUM, COLUMNS), "the number of columns, each of column_mass")


def _twice(document: Document, what: str, given: list[str]) -> Fault:
    """Point at the last one written and name the places of the others."""
    order = [(document.key_place((*PODIUM, name)), name) for name in given]
    *others, last = [n for _, n in sorted(order, key=lambda o: (o[0].rank, o[0].line, o[0].column))]
    named = (f"podium.{name}{document.where((*PODIUM, name))}" for name in others)
    both = "both" if len(others) == 1 else "together"
    text = f"podium.{last} and {listed(named, 'and')} {both} fix {what}; remove one of them"
    return Fault((*PODIUM, last), text, at_key=True)


RATIOS = ("semi_diagonal", "slenderness", "wedge_slenderness", "curvature_ratio")
MEANINGS = {
    "semi_diagonal": "R = sqrt(H^2 + B^2), as in '1.5 m'",
    "slenderness": "tan(alpha) = B/H, as in 0.15",
    "curvature_ratio": "rho = r/2H, as in 0.5; 0 for flat ends, or the word critical",
}


def _bearing(file: CaseFile, document: Document) -> Iterator[Fault]:
    """One description of the column, and a complete one."""
    bearing, sizes = file.podium.bearing, file.podium.bearing.dimensions
    ratios = _given(bearing, RATIOS)
    if sizes is not None:
        for name in ratios:
            yield Fault(
                (*BEARING, name),
                f"podium.bearing.{name} and podium.bearing.dimensions{document.where(DIMENSIONS)}"
                " both describe the column; keep the ratios or the dimensions",
                at_key=True,
            )
        if sizes.wedge_width is None and sizes.radius and not ratios:
            meaning = "2B', across the outer edges of the arcs; only flat ends need none"
            yield _missing((*DIMENSIONS, "wedge_width"), meaning)
    elif not ratios:
        names = listed(RATIOS, "and")
        text = f"podium.bearing has no shape: give {names}, or dimensions"
        yield Fault(BEARING, text, at_key=True)
    else:
        for name, meaning in MEANINGS.items():
            if name not in ratios:
                yield _missing((*BEARING, name), meaning)
        if bearing.wedge_slenderness is None and bearing.curvature_ratio:
            meaning = "tan(alpha') = B'/H; only flat ends need none"
            yield _missing((*BEARING, "wedge_slenderness"), meaning)


def _impact(file: CaseFile, document: Document) -> Iterator[Fault]:
    """The law `value` has a restitution; the other laws give one, of which `loss` takes a part."""
    impact, path = file.podium.impact, (*IMPACT, "restitution")
    if impact.law != "value":
        if impact.restitution is not None:
            where = document.where((*IMPACT, "law"))
            yield Fault(
                path,
                f"podium.impact.restitution does not go with law {impact.law}{where},"
                " which gives its own; remove it, write law: value, or change the law by loss or"
                " factor",
                at_key=True,
            )
        return
    if impact.restitution is None:
        yield _missing(path, "law value needs one, as in 0.92")
    if impact.loss not in (None, 1.0):
        text = (
            "podium.impact.loss does not go with law value: a measured restitution includes"
            " the loss; remove it, or scale the restitution by factor"
        )
        yield Fault((*IMPACT, "loss"), text, at_key=True)


def _contact(file: CaseFile, document: Document) -> Iterator[Fault]:
    """Compliant ends come down without bounces that could be left out."""
    # The default may stand there, in a case that was written out whole.
    default = AnalysisSection.model_fields["recontact_tolerance"].default
    if file.podium.contact.kind != "rigid" and file.analysis.recontact_tolerance != default:
        text = (
            "analysis.recontact_tolerance has no effect with podium.contact"
            f"{document.where((*CONTACT, 'kind'))}: compliant ends do not bounce; remove it"
        )
        yield Fault(("analysis", "recontact_tolerance"), text, at_key=True)


def _devices(file: CaseFile, document: Document) -> Iterator[Fault]:
    """Each device has the keys of its kind, and there are not too many."""
    devices = file.podium.devices
    if len(devices) > MOST_DEVICES:
        yield Fault(
            DEVICES,
            f"podium.devices has {len(devices)} devices, at most {MOST_DEVICES} are followed;"
            " write equal ones as one, with the sum of their forces and stiffnesses",
            at_key=True,
        )
    for index, device in enumerate(devices):
        yield from _device(device, (*DEVICES, index), document)
    of_columns = [i for i, each in enumerate(devices) if LAWS[each.kind].in_each_column()]
    if of_columns and file.podium.columns is None:
        yield Fault(
            (*DEVICES, of_columns[0]),
            f"podium.devices.{of_columns[0]} is in each column, but podium.columns, their"
            " number, is missing",
        )


def _device(device: DeviceSection, path: Path, document: Document) -> Iterator[Fault]:
    """The keys that a kind needs, and none of another kind; a tendon carries its prestress."""
    needed, optional = DEVICE_KEYS[device.kind]
    given = [key for key in _given(device, DeviceSection.model_fields) if key != "kind"]
    for key in needed:
        if key not in given:
            yield _missing((*path, key), DeviceSection.model_fields[key].description or "")
    for key in given:
        if key not in (*needed, *optional):
            known = listed((*needed, *optional), "and")
            text = f"is not a key of kind: {device.kind}, which has {known}; remove it"
            yield Fault((*path, key), f"{dotted((*path, key))} {text}", at_key=True)
    least, most = device.prestress or 0.0, device.yield_force or math.inf
    if device.kind == "tendon" and most <= least:
        force, prestress = (document.at((*path, key)) for key in ("yield_force", "prestress"))
        yield Fault(
            (*path, "yield_force"),
            f"{dotted(path)}.yield_force = {force} must be > prestress ="
            f" {prestress}{document.where((*path, 'prestress'))}; use a lower prestress, or"
            " leave yield_force out for a tendon that never yields",
        )


def _record(file: CaseFile, document: Document) -> Iterator[Fault]:
    """A record has a factor, or a measure that fixes it; a pair is said in one way."""
    record = file.record
    if record is None:
        return
    if record.x is not None:
        if document.has(("record", "source")):
            where = document.where(("record", "source"))
            text = f"record.x and record.source{where} both name the first component"
            yield Fault(("record", "x"), f"{text}; keep one of them", at_key=True)
        if record.y is None:
            meaning = "the second component beside x; one alone is a source"
            yield _missing(("record", "y"), meaning)
    both = record.y is not None
    for name in ("source" if record.x is None else "x", *(["y"] if both else [])):
        try:
            source = Source.parse(getattr(record, name))
        except RecordError as error:
            yield Fault(("record", name), f"record.{name}: {error}")
            continue
        if record.y is not None and source.of_pair:
            text = "names a pair or a direction between two components; name single components here"
            yield Fault(("record", name), f"record.{name} {text}, or leave y out and write `?both`")
        both = both or source.both
    if record.rotation is not None and not both:
        text = "record.rotation turns a pair: give y as well, or write `?both` behind the source"
        text += "; angle= is one direction between two"
        yield Fault(("record", "rotation"), text, at_key=True)
    if record.scale_to is not None and record.scale != 1.0:
        where = document.where(("record", "scale"))
        text = f"record.scale_to and record.scale{where} both fix the factor; keep one of them"
        yield Fault(("record", "scale_to"), text, at_key=True)


def _limits(file: CaseFile, document: Document) -> Iterator[Fault]:
    """A limit on something that the case cannot give would never be exceeded."""
    building = file.superstructure
    if building.storeys == 0:
        for name in _given(file.limits, (q.name for q in LIMITED if "superstructure" in q.needs)):
            text = f"needs a building, but superstructure.storeys = 0{document.where(STOREYS)}"
            fault = f"limits.{name} {text}; remove the limit"
            yield Fault(("limits", name), fault, at_key=True)
        return
    if _given(file.limits, ("drift_ratio",)) and building.storey_height is None:
        text = "limits.drift_ratio needs superstructure.storey_height, which is missing"
        yield Fault(("limits", "drift_ratio"), text, at_key=True)
    needed = {
        "the overturning moment": ("podium.plan", file.podium.plan),
        "the shock of impacts": ("superstructure.vertical_period", building.vertical_period),
    }
    lacking = {what: key for what, (key, value) in needed.items() if value is None}
    for name in _given(file.limits, ("max_column_force", "min_column_force")) if lacking else ():
        yield Fault(
            ("limits", name),
            f"limits.{name}: the force of a column is known without"
            f" {listed(lacking, 'and')} only, and may be several times as large with it; give"
            f" {listed(lacking.values(), 'and')}",
            at_key=True,
        )


def _plan(file: CaseFile, document: Document) -> Iterator[Fault]:
    """Rows of columns are complete, and have heights for the moment of the building."""
    plan, path = file.podium.plan, (*PODIUM, "plan")
    if plan is None:
        return
    given = _given(plan, ("length", "rows"))
    if len(given) != 1:
        text = "give length, between two rows of columns, or the places of all rows"
        yield Fault(path, f"podium.plan: {text}; not {'both' if given else 'neither'}")
    if plan.rows is not None and len(set(plan.rows)) < 2:
        written = shown(document.at((*path, "rows")))
        text = f"podium.plan.rows = {written} must be two or more different positions"
        yield Fault((*path, "rows"), f"{text}, as in [0, 4 m, 8 m]")
    if file.superstructure.storeys and file.superstructure.storey_height is None:
        text = "podium.plan needs superstructure.storey_height: the moment has lever arms"
        yield Fault(path, text, at_key=True)


def faults_of_shape(shape: Shape, file: CaseFile, document: Document) -> Iterator[Fault]:
    """Columns whose ends do not fit together, or do not hold them upright."""
    if shape.slenderness == 0.0:
        if shape.curvature_ratio <= 0.5:
            yield _small_sphere(shape, file)
        for index, device in enumerate(file.podium.devices):
            if device.kind == "tendon":
                text = (
                    f"podium.devices.{index}: tendons are not followed in columns without a flat"
                    " part; leave it out, or give the columns a flat part above 0"
                )
                yield Fault((*DEVICES, index), text, at_key=True)
    elif shape.curvature_ratio and shape.wedge_slenderness < shape.slenderness:
        yield _narrow_wedge(shape, file, document)
    elif shape.curvature_ratio:
        yield from _short_arc(shape, file)


def _small_sphere(shape: Shape, file: CaseFile) -> Fault:
    """Spherical ends: the column stands as long as its centre is below that of the arc."""
    path, flat = (*BEARING, "curvature_ratio"), "slenderness"
    value, least = f"{shape.curvature_ratio:g}", "0.5"
    if sizes := file.podium.bearing.dimensions:
        path, value, flat = (*DIMENSIONS, "radius"), f"{sizes.radius:g} m", "width"
        least = f"{0.5 * sizes.height:g} m, half the height,"
    return Fault(
        path,
        f"{dotted(path)} = {value} must be > {least} with {flat}: 0: without a flat"
        " part a smaller arc does not hold the columns upright; use a larger one, or a"
        f" {flat} above 0",
    )


def _narrow_wedge(shape: Shape, file: CaseFile, document: Document) -> Fault:
    owner, name, limit = BEARING, "wedge_slenderness", "slenderness"
    wedge, flat = shape.wedge_slenderness, shape.slenderness
    degrees = ""
    if file.podium.bearing.dimensions:
        owner, name, limit = DIMENSIONS, "wedge_width", "width"
        wedge, flat = (document.at((*DIMENSIONS, key)) for key in (name, limit))
    elif 1.0 < flat < 45.0:
        angle = math.tan(math.radians(flat))
        degrees = f"; slenderness is tan(alpha), of {flat:g} degrees {angle:.4f}"
    where, path = document.where((*owner, limit)), (*owner, name)
    text = f"{dotted(path)} = {wedge} must be >= {limit} = {flat}{where}"
    return Fault(path, f"{text}: the arcs lie outside the flat part{degrees}")


def _short_arc(shape: Shape, file: CaseFile) -> Iterator[Fault]:
    """0 <= sin(beta) = (tan alpha' - tan alpha)/(2 rho) <= 1 (Theory (1.1))."""
    rise, sizes = shape.wedge_slenderness - shape.slenderness, file.podium.bearing.dimensions
    if rise <= 2.0 * shape.curvature_ratio:
        return
    if sizes:
        yield Fault(
            (*DIMENSIONS, "radius"),
            f"podium.bearing.dimensions.radius = {sizes.radius:g} m is too small an arc to reach"
            f" the wedge's edge; use a radius of at least {above(0.5 * rise * sizes.height)} m or"
            f" a wedge_width of at most {below(sizes.width + 2.0 * sizes.radius)} m",
        )
    elif file.podium.bearing.curvature_ratio == "critical":
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


def faults_of_motion(
    bearing: Bearing, law: ImpactLaw, masses: Masses, file: CaseFile
) -> Iterator[Fault]:
    """Columns that would not pass upright, or that have overturned before or after the model."""
    yield from _restitution(bearing, law, masses, file)
    analysis, critical = file.analysis, bearing.critical_rotation
    if analysis.overturning_limit * critical > bearing.largest_rotation:
        yield Fault(
            ("analysis", "overturning_limit"),
            f"analysis.overturning_limit = {analysis.overturning_limit:g} times theta_cr ="
            f" {critical:.6g} rad must not exceed {bearing.largest_rotation:.6g} rad, where the"
            " columns lie down and the model ends; use at most"
            f" {below(bearing.largest_rotation / critical)}",
        )
    limit = overturning_limit(analysis, bearing) * critical
    if abs(analysis.initial_rotation) >= limit:
        yield Fault(
            ("analysis", "initial_rotation"),
            f"analysis.initial_rotation = {analysis.initial_rotation:g} rad must stay below the"
            f" overturning limit, {limit:.6g} rad (overturning_limit * theta_cr, or less); use less"
            f" than {below(limit)}",
        )


def _restitution(
    bearing: Bearing, law: ImpactLaw, masses: Masses, file: CaseFile
) -> Iterator[Fault]:
    """The impact law sends the columns to their other edge: 0 < e <= 1 (Theory, section 4)."""
    gamma, eta = masses.gamma, masses.eta
    e = law.ratio(bearing, gamma, eta)
    if bearing.is_spherical:
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
        widest = largest_slenderness(law, bearing.inertia_ratio, gamma, eta)
        lost = "" if law.loss == 1.0 else f", loss {law.loss:g}"
        under, lighter = "", ""
        if law.kind == "flexible" and eta > 0.0:
            beam, sin2 = 4.0 * gamma, math.sin(bearing.alpha) ** 2
            most = (bearing.inertia_ratio + beam) / sin2 - 2.0 * law.loss * (1.0 + beam)
            most /= (2.0 * law.loss - 1.0) * beam
            under = f" under a building of {eta:g} times the cap beam's mass"
            lighter = (
                f", a building of less than {below(most)} times that mass" if most > 0.0 else ""
            )
        yield Fault(
            (*BEARING, "dimensions" if file.podium.bearing.dimensions else "slenderness"),
            f"podium.bearing: the slenderness tan(alpha) = {bearing.slenderness:g}{under} gives the"
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
