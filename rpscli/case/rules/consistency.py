"""Rules that join several keys of a case, each of which is valid in itself."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from rpscli.analyses.result_quantities import LIMITED, YIELDING
from rpscli.case.build import overturning_limit
from rpscli.case.schema import case_file
from rpscli.case.text.document import Document, Fault, path_of, shown
from rpscli.errors import RecordError, listed
from rpscli.model.bearing import Bearing
from rpscli.model.devices import DEVICES
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

    def _where(self, key: str) -> str:
        return self.document.where(path_of(key))

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
        """The other laws than `value` give a restitution, of which `loss` is a part."""
        impact = self.file.podium.impact
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
        """Each device has the keys of its kind."""
        devices = self.file.podium.devices
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
        """The keys that a kind needs, and none of another kind."""
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
        """Rows have heights for the moment of the building; the force of one column a number."""
        plan, building = self.file.podium.plan, self.file.superstructure
        if self.file.podium.column is not None and self.file.podium.columns is None:
            yield _at_key("podium.columns", f" is missing: {COLUMN_KEY} asks for the force of one")
        if plan is None:
            return
        given = _given(plan, "length", "rows")
        if len(given) != 1:
            text = ": give length, between two rows of columns, or the places of all rows; not"
            yield _of_value("podium.plan", f"{text} {'both' if given else 'neither'}")
        if building.storeys and building.storey_height is None:
            text = " needs superstructure.storey_height: the moment has lever arms"
            yield _at_key("podium.plan", text)

    def faults_of_bearing(self, bearing: Bearing) -> Iterator[Fault]:
        """Limits and strengths that its ends do not have, and rotations beyond the model."""
        file, analysis, critical = self.file, self.file.analysis, bearing.critical_rotation
        if bearing.is_flat and file.limits.contact_pressure_ratio is not None:
            text = " needs curved ends: flat ones stand on edges; limit crushed_width_ratio"
            yield _at_key("limits.contact_pressure_ratio", text)
        yields = file.superstructure.yields
        if bearing.is_spherical and yields is not None and yields.ratio is not None:
            text = ": columns without a flat part have no V_st; give the shears in place of a ratio"
            yield _at_key(f"{YIELD}.ratio", text)
        most = bearing.largest_rotation / critical
        if analysis.overturning_limit > most:
            yield _of_value(
                "analysis.overturning_limit",
                f" = {analysis.overturning_limit:g} times theta_cr = {critical:.6g} rad must not"
                f" exceed {bearing.largest_rotation:.6g} rad, where the columns lie down and the"
                f" model ends; use at most {math.floor(1e3 * most) / 1e3:g}",
            )
        limit = overturning_limit(analysis, bearing) * critical
        if abs(analysis.initial_rotation) >= limit:
            yield _of_value(
                "analysis.initial_rotation",
                f" = {analysis.initial_rotation:g} rad must stay below the overturning limit,"
                f" {limit:.6g} rad (overturning_limit * theta_cr, or less); use a smaller one",
            )


OF_THE_MODEL = {
    "slenderness": f"{BEARING}.slenderness",
    "wedge_slenderness": f"{BEARING}.wedge_slenderness",
    "curvature_ratio": f"{BEARING}.curvature_ratio",
    "restitution": "podium.impact",
    "law": "podium.impact.restitution",
    "devices": "podium.devices",
    "yield_force": "podium.devices",
    "edge_length": f"{COLUMN_KEY}.edge_length",
    "rows": "podium.plan.rows",
    "contact": "podium.contact",
    "initial_rotation": "analysis.initial_rotation",
}
"""Keys of a case by the word with which the model begins a refusal."""


def refused_by_model(error: ValueError, document: Document) -> Fault:
    """What the model refuses, at the key that it is about."""
    text = str(error)
    key = OF_THE_MODEL.get(text.split(maxsplit=1)[0].strip(":,"), "podium")
    if document.has(path_of(DIMENSIONS)) and key.startswith(BEARING):
        key = DIMENSIONS
    parent, _, last = key.rpartition(".")
    named = text.startswith((f"{last} ", f"{last}:"))
    whole = f"{parent}.{text}" if named else f"{key}: {text}"
    return Fault(path_of(key), whole, at_key=not named)
