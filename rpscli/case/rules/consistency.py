"""Rules that join several keys of a case, each of which is valid in itself."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from rpscli.analyses.result_quantities import LIMITED, YIELDING
from rpscli.case.build import Masses, Shape, overturning_limit
from rpscli.case.schema import case_file
from rpscli.case.text.document import Document, Fault, path_of, shown
from rpscli.errors import RecordError, listed
from rpscli.model.bearing import Bearing
from rpscli.model.devices import DEVICES
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import MOST_DEVICES
from rpscli.records.source import Source

STOREYS = "superstructure.storeys"
YIELD = "superstructure.yield"
BEARING, DIMENSIONS = "podium.bearing", "podium.bearing.dimensions"
GAMMA, ETA = "podium.cap_beam_mass_ratio", "podium.superstructure_mass_ratio"
BEAM, COLUMN = "podium.cap_beam_mass", "podium.column_mass"
COLUMN_KEY = "podium.column"
COLUMN_LIMITS = tuple(q.name for q in LIMITED if q.needs in {"designed columns", "columns on arcs"})
RATIOS = {
    "semi_diagonal": "R = sqrt(H^2 + B^2), as in '1.5 m'",
    "slenderness": "tan(alpha) = B/H, as in 0.15",
    "wedge_slenderness": "tan(alpha') = B'/H; only flat ends need none",
    "curvature_ratio": "rho = r/2H, as in 0.5; 0 for flat ends, or the word critical",
}


def _at_key(key: str, text: str) -> Fault:
    """A fault of a key, with which the text begins."""
    return Fault(path_of(key), f"{key}{text}", at_key=True)


def _of_value(key: str, text: str) -> Fault:
    return Fault(path_of(key), f"{key}{text}")


def _given(section: object, *keys: str) -> list[str]:
    """Those of the optional keys of a section, with or without what precedes them, with a value."""
    return [key for key in keys if getattr(section, key.rpartition(".")[2]) is not None]


@dataclass(frozen=True)
class Consistency:
    """A case whose sections are valid, and what joins their keys."""

    file: case_file.CaseFile
    document: Document

    def faults(self) -> Iterator[Fault]:
        """Keys that are missing, said twice, or cannot be true together, whatever the shape."""
        building = self.file.superstructure
        if building.storeys:
            yield from self._building(building)
            yield from self._masses_under_building()
        else:
            yield from self._masses_of_frame()
        yield from self._bearing()
        yield from self._impact()
        yield from self._devices()
        yield from self._record()
        yield from self._limits()
        yield from self._plan()
        yield from self._column()

    def _where(self, key: str) -> str:
        return self.document.where(path_of(key))

    def _written(self, key: str) -> str:
        return shown(self.document.at(path_of(key)))

    def _building(self, building: case_file.SuperstructureSection) -> Iterator[Fault]:
        """A building needs masses, stiffness and damping, each given once."""
        if building.storey_mass is None:
            meaning = "floor mass, one value or a list from the bottom, as in '200 t'"
            yield _at_key("superstructure.storey_mass", f" is missing: {meaning}")
        if building.damping is None:
            meaning = "as in {ratio: 0.05, modes: [1, 2]} (Rayleigh) or {ratio: 0.05} (every mode)"
            yield _at_key("superstructure.damping", f" is missing: {meaning}")
        if building.vertical_damping is not None and building.vertical_period is None:
            text = " needs superstructure.vertical_period, which is missing; give it, or remove"
            yield _at_key("superstructure.vertical_damping", f"{text} the key")
        modes = None if building.damping is None else building.damping.modes
        if modes and max(modes) > max(building.storeys, 2):
            # One storey takes [1, 2] as well: stiffness-proportional, so that storeys can vary.
            yield _of_value(
                "superstructure.damping.modes",
                f" = {shown(modes)} must be from 1 to {STOREYS} ="
                f" {building.storeys}{self._where(STOREYS)}; a building has as many modes as"
                " storeys",
            )
        for owner, section in (("superstructure", building), ("superstructure.y", building.y)):
            if section is not None:
                yield from self._stiffness(owner, section)
        if building.yields is not None:
            given = _given(building.yields, "ratio", "shears")
            if len(given) != 1:
                text = ": give ratio, F_1 over V_st, or the shears at which storeys yield; not"
                yield _of_value(YIELD, f"{text} {'both' if given else 'neither'}")
            yield from self._one_each(YIELD, building.yields, "shears")

    def _stiffness(
        self, owner: str, section: case_file.SuperstructureSection | case_file.AcrossSection
    ) -> Iterator[Fault]:
        """Stiffnesses follow from a period or are given; lists have one value a storey."""
        if section.stiffness is None and section.period is None:
            yield _at_key(owner, " has no stiffness: give period (with profile), or stiffness")
        if section.stiffness is not None:
            for key in _given(section, f"{owner}.period", f"{owner}.profile"):
                text = f" and {key}{self._where(key)} both fix the storey stiffnesses"
                yield _at_key(f"{owner}.stiffness", f"{text}; keep one of them")
        yield from self._one_each(owner, section, "storey_mass", "storey_height", "stiffness")

    def _one_each(self, owner: str, section: object, *names: str) -> Iterator[Fault]:
        """Lists have one value a storey."""
        storeys = self.file.superstructure.storeys
        for name in names:
            values = getattr(section, name, None)
            if isinstance(values, tuple) and len(values) != storeys:
                yield _of_value(
                    f"{owner}.{name}",
                    f" has {len(values)} values, but {STOREYS} = {storeys}{self._where(STOREYS)};"
                    " give one value a storey from the bottom, or a single value",
                )

    def _masses_under_building(self) -> Iterator[Fault]:
        """Cap beam and columns each have one mass."""
        podium = self.file.podium
        for what, keys in {
            "the mass of the cap beam": (ETA, BEAM),
            "the mass of the columns": (GAMMA, COLUMN),
        }.items():
            given = _given(podium, *keys)
            if not given:
                names = listed(key.rpartition(".")[2] for key in keys)
                yield _at_key("podium", f" leaves {what} open: give {names}")
            elif len(given) > 1:
                yield self._twice(what, given)
        yield from self._number_of_columns()
        for key, value in ((GAMMA, podium.cap_beam_mass_ratio), (BEAM, podium.cap_beam_mass)):
            if value == 0.0:
                yield _of_value(
                    key,
                    f" = 0 must be > 0: the superstructure{self._where(STOREYS)} stands on the cap"
                    f" beam; 0 is for free-standing columns, with {STOREYS}: 0",
                )

    def _masses_of_frame(self) -> Iterator[Fault]:
        """Without a building two of three: beam mass, column mass, and their ratio."""
        podium, keys = self.file.podium, (BEAM, GAMMA, COLUMN)
        given = _given(podium, *keys)
        if podium.superstructure_mass_ratio is not None:
            text = f" has no meaning with {STOREYS} = 0{self._where(STOREYS)}; give {BEAM} instead"
            yield _at_key(ETA, text)
        elif len(given) > 2:
            yield self._twice("the masses of cap beam and columns", given)
        elif podium.without_cap_beam and (podium.cap_beam_mass_ratio or podium.cap_beam_mass):
            yield _of_value(
                BEAM,
                f" and {GAMMA}{self._where(GAMMA)} contradict each other: one says that there is no"
                " cap beam; give column_mass instead of one of them",
            )
        elif podium.without_cap_beam:
            if podium.column_mass is None:
                yield _at_key(COLUMN, " is missing: without a cap beam it is the only mass")
        else:
            if len(given) < 2:
                others = listed(key.rpartition(".")[2] for key in keys if key not in given)
                text = " leaves the masses of cap beam and columns open: give"
                text += f" {'one' if given else 'two'} of {others} (column_mass with columns)"
                yield _at_key("podium", text)
            yield from self._number_of_columns()

    def _number_of_columns(self) -> Iterator[Fault]:
        if self.file.podium.column_mass is not None and self.file.podium.columns is None:
            meaning = "the number of columns, each of column_mass"
            yield _at_key("podium.columns", f" is missing: {meaning}")

    def _twice(self, what: str, given: list[str]) -> Fault:
        """Point at the last one written and name the places of the others."""
        places = {key: self.document.key_place(path_of(key)) for key in given}
        order = sorted(given, key=lambda k: (places[k].rank, places[k].line, places[k].column))
        others = listed((f"{key}{self._where(key)}" for key in order[:-1]), "and")
        both = "both" if len(given) == 2 else "together"
        return _at_key(order[-1], f" and {others} {both} fix {what}; remove one of them")

    def _bearing(self) -> Iterator[Fault]:
        """One description of the column, and a complete one."""
        bearing, sizes = self.file.podium.bearing, self.file.podium.bearing.dimensions
        ratios = _given(bearing, *RATIOS)
        if sizes is None and not ratios:
            names = listed(RATIOS, "and")
            yield _at_key(BEARING, f" has no shape: give {names}, or dimensions")
        elif sizes is None:
            for name, meaning in RATIOS.items():
                optional = name == "wedge_slenderness" and not bearing.curvature_ratio
                if name not in ratios and not optional:
                    yield _at_key(f"{BEARING}.{name}", f" is missing: {meaning}")
        elif ratios:
            text = f" and {DIMENSIONS}{self._where(DIMENSIONS)} both describe the column"
            for name in ratios:
                yield _at_key(f"{BEARING}.{name}", f"{text}; keep the ratios or the dimensions")
        elif sizes.wedge_width is None and sizes.radius:
            meaning = "2B', across the outer edges of the arcs; only flat ends need none"
            yield _at_key(f"{DIMENSIONS}.wedge_width", f" is missing: {meaning}")

    def _impact(self) -> Iterator[Fault]:
        """The law `value` has a restitution; the other laws give one, of which `loss` is a part."""
        impact, key = self.file.podium.impact, "podium.impact.restitution"
        if impact.law != "value" and impact.restitution is not None:
            yield _at_key(
                key,
                f" does not go with law {impact.law}{self._where('podium.impact.law')}, which gives"
                " its own; remove it, write law: value, or change the law by loss or factor",
            )
        if impact.law == "value" and impact.restitution is None:
            yield _at_key(key, " is missing: law value needs one, as in 0.92")
        if impact.law == "value" and impact.loss not in (None, 1.0):
            yield _at_key(
                "podium.impact.loss",
                " does not go with law value: a measured restitution includes the loss; remove it,"
                " or scale the restitution by factor",
            )
        podium, ends, sections = self.file.podium, "", [("podium.impact", "contact_time")]
        if podium.contact.kind != "rigid":
            ends = f"with podium.contact{self._where('podium.contact.kind')}: compliant ends do not"
            ends += " bounce"
            sections.append(("analysis", "recontact_tolerance"))
        elif podium.bearing.slenderness == 0.0:
            ends = f"without a flat part{self._where(f'{BEARING}.slenderness')}: such ends roll"
            ends += " through upright without an impact"
        # The default may stand there, in a case that was written out whole.
        for owner, name in sections if ends else ():
            section = impact if name == "contact_time" else self.file.analysis
            if getattr(section, name) != type(section).model_fields[name].default:
                yield _at_key(f"{owner}.{name}", f" has no effect {ends}; remove it")

    def _devices(self) -> Iterator[Fault]:
        """Each device has the keys of its kind, and there are not too many."""
        devices = self.file.podium.devices
        if len(devices) > MOST_DEVICES:
            yield _at_key(
                "podium.devices",
                f" has {len(devices)} devices, at most {MOST_DEVICES} are followed; write equal"
                " ones as one, with the sum of their forces and stiffnesses",
            )
        for index, device in enumerate(devices):
            yield from self._device(f"podium.devices.{index}", device)
        kinds = [DEVICES.get(each.kind) for each in devices]
        of_columns = [i for i, kind in enumerate(kinds) if kind and kind.in_each_column]
        if of_columns and self.file.podium.columns is None:
            yield _of_value(
                f"podium.devices.{of_columns[0]}",
                " is in each column, but podium.columns, their number, is missing",
            )

    def _device(self, owner: str, device: case_file.DeviceSection) -> Iterator[Fault]:
        """The keys that a kind needs, and none of another kind; a tendon carries its prestress."""
        fields = type(device).model_fields
        own = tuple(key for key, field in fields.items() if field.is_required())
        needed, optional = case_file.DEVICE_KEYS.get(device.kind, (own, ()))
        given = _given(device, *fields)
        for key in needed:
            if key not in given:
                meaning = case_file.DeviceSection.model_fields[key].description
                yield _at_key(f"{owner}.{key}", f" is missing: {meaning}")
        for key in given:
            if key not in ("kind", *needed, *optional):
                known = listed((*needed, *optional), "and")
                text = f" is not a key of kind: {device.kind}, which has {known}; remove it"
                yield _at_key(f"{owner}.{key}", text)
        least, most = device.prestress or 0.0, device.yield_force or math.inf
        if device.kind == "tendon" and most <= least:
            force, prestress = (
                self.document.at(path_of(f"{owner}.{key}")) for key in ("yield_force", "prestress")
            )
            yield _of_value(
                f"{owner}.yield_force",
                f" = {force} must be > prestress = {prestress}{self._where(f'{owner}.prestress')};"
                " use a lower prestress, or leave yield_force out for a tendon that never yields",
            )

    def _record(self) -> Iterator[Fault]:
        """A record has a factor, or a measure that fixes it; a pair is said in one way."""
        record = self.file.record
        if record is None:
            return
        if record.x is not None and self.document.has(("record", "source")):
            text = f" and record.source{self._where('record.source')} both name the first component"
            yield _at_key("record.x", f"{text}; keep one of them")
        if record.x is not None and record.y is None:
            meaning = "the second component beside x; one alone is a source"
            yield _at_key("record.y", f" is missing: {meaning}")
        both = record.y is not None
        for name in _given(record, "source" if record.x is None else "x", "y"):
            try:
                source = Source.parse(getattr(record, name))
            except RecordError as error:
                yield _of_value(f"record.{name}", f": {error}")
                continue
            if record.y is not None and source.of_pair:
                text = " names a pair or a direction between two components; name single components"
                yield _of_value(f"record.{name}", f"{text} here, or leave y out and write `?both`")
            both = both or source.both
        if record.rotation is not None and not both:
            text = " turns a pair: give y as well, or write `?both` behind the source"
            yield _at_key("record.rotation", f"{text}; angle= is one direction between two")
        if record.scale_to is not None and record.scale != 1.0:
            text = f" and record.scale{self._where('record.scale')} both fix the factor"
            yield _at_key("record.scale_to", f"{text}; keep one of them")

    def _limits(self) -> Iterator[Fault]:
        """A limit on something that the case cannot give would never be exceeded."""
        limits, building = self.file.limits, self.file.superstructure
        for name in _given(limits, *COLUMN_LIMITS) if self.file.podium.column is None else ():
            yield _at_key(f"limits.{name}", f" needs {COLUMN_KEY}, which is missing")
        if building.storeys == 0:
            for name in _given(limits, *(q.name for q in LIMITED if "superstructure" in q.needs)):
                text = f" needs a building, but {STOREYS} = 0{self._where(STOREYS)}"
                yield _at_key(f"limits.{name}", f"{text}; remove the limit")
            return
        if building.storey_height is None:
            for name in _given(limits, "drift_ratio", "residual_drift_ratio"):
                text = " needs superstructure.storey_height, which is missing"
                yield _at_key(f"limits.{name}", text)
        if building.yields is None:
            for name in _given(limits, *(q.name for q in YIELDING if q.limit)):
                text = f" needs {YIELD}, strengths of storeys, which is missing; give it"
                yield _at_key(f"limits.{name}", f"{text}, or remove the limit")
        needed = {
            "the overturning moment": ("podium.plan", self.file.podium.plan),
            "the shock of impacts": ("superstructure.vertical_period", building.vertical_period),
        }
        lacking = {what: key for what, (key, value) in needed.items() if value is None}
        forces = "max_column_force", "min_column_force", *COLUMN_LIMITS
        for name in _given(limits, *forces) if lacking else ():
            yield _at_key(
                f"limits.{name}",
                f": the force of a column is known without {listed(lacking, 'and')} only, and may"
                f" be several times as large with it; give {listed(lacking.values(), 'and')}",
            )

    def _plan(self) -> Iterator[Fault]:
        """Rows of columns are complete, and have heights for the moment of the building."""
        plan, building = self.file.podium.plan, self.file.superstructure
        if plan is None:
            return
        given = _given(plan, "length", "rows")
        if len(given) != 1:
            text = ": give length, between two rows of columns, or the places of all rows; not"
            yield _of_value("podium.plan", f"{text} {'both' if given else 'neither'}")
        if plan.rows is not None and len(set(plan.rows)) < 2:
            text = f" = {self._written('podium.plan.rows')} must be two or more different positions"
            yield _of_value("podium.plan.rows", f"{text}, as in [0, 4 m, 8 m]")
        if building.storeys and building.storey_height is None:
            text = " needs superstructure.storey_height: the moment has lever arms"
            yield _at_key("podium.plan", text)

    def _column(self) -> Iterator[Fault]:
        """Square columns bear on lines, which have a length."""
        column, key = self.file.podium.column, f"{COLUMN_KEY}.edge_length"
        if column is None:
            return
        if self.file.podium.columns is None:
            yield _at_key("podium.columns", f" is missing: {COLUMN_KEY} asks for the force of one")
        if column.section == "square" and column.edge_length is None:
            text = " is missing: a square column bears on a line, whose length it is, as in 0.45 m"
            yield _at_key(key, text)
        if column.section == "round" and column.edge_length is not None:
            section = self._where(f"{COLUMN_KEY}.section")
            text = f" does not go with section: round{section}, which bears on a point; remove it"
            yield _at_key(key, text)

    def faults_of_shape(self, shape: Shape) -> Iterator[Fault]:
        """Columns whose ends do not fit together, or do not hold them upright."""
        if not shape.curvature_ratio or shape.wedge_slenderness == shape.slenderness:
            for name in _given(self.file.limits, "contact_pressure_ratio"):
                text = " needs curved ends: flat ones stand on edges; limit crushed_width_ratio"
                yield _at_key(f"limits.{name}", text)
        if shape.slenderness > 0.0:
            if shape.curvature_ratio:
                yield from self._faults_of_arc(shape)
            return
        if shape.curvature_ratio <= 0.5:
            key, flat = f"{BEARING}.curvature_ratio", "slenderness"
            value, least = f"{shape.curvature_ratio:g}", "0.5"
            if sizes := self.file.podium.bearing.dimensions:
                key, value, flat = f"{DIMENSIONS}.radius", f"{sizes.radius:g} m", "width"
                least = f"{0.5 * sizes.height:g} m, half the height,"
            yield _of_value(
                key,
                f" = {value} must be > {least} with {flat}: 0: without a flat part a smaller arc"
                f" does not hold the columns upright; use a larger one, or a {flat} above 0",
            )
        if (yields := self.file.superstructure.yields) is not None and yields.ratio is not None:
            text = ": columns without a flat part have no V_st; give the shears in place of a ratio"
            yield _at_key(f"{YIELD}.ratio", text)
        for index, device in enumerate(self.file.podium.devices):
            if device.kind == "tendon":
                yield _at_key(
                    f"podium.devices.{index}",
                    ": tendons are not followed in columns without a flat part; leave it out, or"
                    " give the columns a flat part above 0",
                )

    def _faults_of_arc(self, shape: Shape) -> Iterator[Fault]:
        """0 <= sin(beta) = (tan alpha' - tan alpha)/(2 rho) <= 1 (Theory (1.1))."""
        _, flat, wedge, rho = shape
        rise, bearing = wedge - flat, self.file.podium.bearing
        sizes = bearing.dimensions
        if rise < 0.0 and sizes:
            width, limit = (
                self.document.at(path_of(f"{DIMENSIONS}.{n}")) for n in ("wedge_width", "width")
            )
            text = f" = {width} must be >= width = {limit}{self._where(f'{DIMENSIONS}.width')}"
            yield _of_value(
                f"{DIMENSIONS}.wedge_width", f"{text}: the arcs lie outside the flat part"
            )
        elif rise < 0.0:
            text = (
                f" = {wedge} must be >= slenderness = {flat}{self._where(f'{BEARING}.slenderness')}"
            )
            text += ": the arcs lie outside the flat part"
            if 1.0 < flat < 45.0:
                angle = math.tan(math.radians(flat))
                text += f"; slenderness is tan(alpha), of {flat:g} degrees {angle:.4f}"
            yield _of_value(f"{BEARING}.wedge_slenderness", text)
        elif rise <= 2.0 * rho:
            return
        elif sizes:
            yield _of_value(
                f"{DIMENSIONS}.radius",
                f" = {sizes.radius:g} m is too small an arc to reach the wedge's edge; use a radius"
                f" of at least {above(0.5 * rise * sizes.height)} m or a wedge_width of at most"
                f" {below(sizes.width + 2.0 * sizes.radius)} m",
            )
        elif bearing.curvature_ratio == "critical":
            yield _of_value(
                f"{BEARING}.wedge_slenderness",
                f" = {wedge:g} must be <= 1 with curvature_ratio: critical: the arc would turn by"
                " more than 90 degrees",
            )
        else:
            yield _of_value(
                f"{BEARING}.curvature_ratio",
                f" = {rho:g} is too small an arc to reach the wedge's edge (sin(beta) ="
                f" {0.5 * rise / rho:.3g} must be <= 1); use a curvature_ratio of at least"
                f" {above(0.5 * rise)} or a wedge_slenderness of at most {below(flat + 2.0 * rho)}",
            )

    def faults_of_motion(self, bearing: Bearing, law: ImpactLaw, masses: Masses) -> Iterator[Fault]:
        """Columns that would not pass upright, or overturn before or after the model holds."""
        yield from self._restitution(bearing, law, masses)
        analysis, critical = self.file.analysis, bearing.critical_rotation
        if analysis.overturning_limit * critical > bearing.largest_rotation:
            yield _of_value(
                "analysis.overturning_limit",
                f" = {analysis.overturning_limit:g} times theta_cr = {critical:.6g} rad must not"
                f" exceed {bearing.largest_rotation:.6g} rad, where the columns lie down and the"
                f" model ends; use at most {below(bearing.largest_rotation / critical)}",
            )
        limit = overturning_limit(analysis, bearing) * critical
        if abs(analysis.initial_rotation) >= limit:
            yield _of_value(
                "analysis.initial_rotation",
                f" = {analysis.initial_rotation:g} rad must stay below the overturning limit,"
                f" {limit:.6g} rad (overturning_limit * theta_cr, or less); use less than"
                f" {below(limit)}",
            )

    def _restitution(self, bearing: Bearing, law: ImpactLaw, masses: Masses) -> Iterator[Fault]:
        """The impact law sends the columns to their other edge: 0 < e <= 1 (Theory, section 4)."""
        gamma, eta = masses.gamma, masses.eta
        if self.file.superstructure.vertical_period is not None:
            eta = 0.0  # floors on springs take no part
        e = law.ratio(bearing, gamma, eta)
        if bearing.is_spherical:
            if e != 1.0:
                text = ": columns without a flat part roll through the upright position and have"
                yield _at_key("podium.impact", f"{text} no impact; remove restitution and factor")
        elif e > 1.0:
            yield _of_value(
                "podium.impact.factor",
                f" = {law.factor:g} gives the restitution {e:.4g}, which must be <= 1; use a factor"
                f" of at most {below(law.factor / e)}",
            )
        elif e <= 0.0:
            widest = largest_slenderness(law, bearing.inertia_ratio, gamma, eta)
            lost = "" if law.loss == 1.0 else f", loss {law.loss:g}"
            under, lighter = "", ""
            if law.kind == "flexible" and eta > 0.0:
                beam, sin2 = 4.0 * gamma, math.sin(bearing.alpha) ** 2
                most = (bearing.inertia_ratio + beam) / sin2 - 2.0 * law.loss * (1.0 + beam)
                most /= (2.0 * law.loss - 1.0) * beam
                under = f" under a building of {eta:g} times the cap beam's mass"
                if most > 0.0:
                    lighter = f", a building of less than {below(most)} times that mass"
            name = "dimensions" if self.file.podium.bearing.dimensions else "slenderness"
            yield Fault(
                path_of(f"{BEARING}.{name}"),
                f"{BEARING}: the slenderness tan(alpha) = {bearing.slenderness:g}{under} gives the"
                f" restitution {e:.4g} (impact law {law.kind}{lost}), which must be > 0 for the"
                f" columns to pass to their other edge; use less than {below(widest)}{lighter}, a"
                " part of the loss with impact: {loss: 0.5}, or a measured value with"
                " impact: {law: value, restitution: ...}",
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


def largest_slenderness(law: ImpactLaw, inertia_ratio: float, gamma: float, eta: float) -> float:
    """tan(alpha) at which a law's restitution is 0 (Theory (4.6), (4.8)); Housner: sin^2 = 2/3."""
    beam, floors = 4.0 * gamma, 4.0 * gamma * eta
    # kappa (1 - e_edge) = 1 with 1 - e_edge = 2 sin^2 (1 + beam + floors)/(Io + ...)
    if law.kind == "rigid":
        sin2 = (inertia_ratio + beam + floors) / (2.0 * law.loss * (1.0 + beam + floors))
    else:
        sin2 = (inertia_ratio + beam) / (2.0 * law.loss * (1.0 + beam + floors) - floors)
    return math.sqrt(sin2 / (1.0 - sin2)) if sin2 < 1.0 else math.inf
