"""Rules that join keys of a case, whose sections are valid each by itself.

They come before the model, which refuses the rest.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from rpscli.case.build import DEVICE_KEYS, overturning_limit, rows_of
from rpscli.case.schema.case_file import CaseFile, DeviceSection, SuperstructureSection
from rpscli.case.schema.fields import Section
from rpscli.case.text.document import Document, Fault, path_of, shown
from rpscli.errors import RecordError, listed
from rpscli.model.bearing import Bearing
from rpscli.model.devices import DEVICES
from rpscli.records.source import Source

STOREYS, HEIGHT, YIELD = (
    f"superstructure.{key}" for key in ("storeys", "storey_height", "yield")
)
BEARING = "podium.bearing"
DIMENSIONS = "podium.bearing.dimensions"
COLUMN = "podium.column"
GAMMA = "podium.cap_beam_mass_ratio"
ETA = "podium.superstructure_mass_ratio"
BEAM = "podium.cap_beam_mass"
COLUMN_MASS = "podium.column_mass"
COLUMNS = "podium.columns"
RATIOS = {
    "semi_diagonal": "R = sqrt(H^2 + B^2), as in '1.5 m'",
    "slenderness": "tan(alpha) = B/H, as in 0.15",
    "wedge_slenderness": "tan(alpha') = B'/H; only flat ends need none",
    "curvature_ratio": "rho = r/2H, as in 0.5; 0 for flat ends, or the word critical",
}


def at_key(key: str, text: str) -> Fault:
    """A fault of a key, with which the text begins."""
    return Fault(path_of(key), f"{key}{text}", at_key=True)


def of_value(key: str, text: str) -> Fault:
    """A fault of the value of a key, with which the text begins."""
    return Fault(path_of(key), f"{key}{text}")


def _given(section: object, *keys: str) -> list[str]:
    """Those of the optional keys of a section, with or without what
    precedes them, with a value.
    """
    return [
        key for key in keys if getattr(section, key.rpartition(".")[2], None) is not None
    ]


def _one_of(key: str, section: object, text: str, *keys: str) -> Iterator[Fault]:
    """A section that takes exactly one of two keys."""
    if section is not None and len(given := _given(section, *keys)) != 1:
        yield of_value(key, f": give {text}; not {'both' if given else 'neither'}")


@dataclass(frozen=True)
class Rules:
    """Rules that join the keys of a case whose sections are valid."""

    file: CaseFile
    document: Document

    def faults(self) -> Iterator[Fault]:
        """Keys that are missing, said twice, or cannot be true
        together, whatever the shape.
        """
        building = self.file.superstructure
        if building.storeys:
            yield from self._building(building)
        yield from (
            self._masses_under_building() if building.storeys else self._masses_of_frame()
        )
        yield from self._bearing()
        yield from self._without_effect()
        yield from self._devices()
        yield from self._record()
        yield from self._columns()

    def _where(self, key: str) -> str:
        return self.document.where(path_of(key))

    def _both(self, key: str, other: str, text: str, keep: str = "one of them") -> Fault:
        """Two keys that say one thing."""
        return at_key(key, f" and {other}{self._where(other)} both {text}; keep {keep}")

    def _building(self, building: SuperstructureSection) -> Iterator[Fault]:
        """A building needs masses, stiffness and damping, each given once."""
        if building.storey_mass is None:
            meaning = "floor mass, one value or a list from the bottom, as in '200 t'"
            yield at_key("superstructure.storey_mass", f" is missing: {meaning}")
        if building.damping is None:
            meaning = (
                "as in {ratio: 0.05, modes: [1, 2]} (Rayleigh) or {ratio: 0.05} (every"
                " mode)"
            )
            yield at_key("superstructure.damping", f" is missing: {meaning}")
        elif (modes := building.damping.modes) and max(modes) > max(building.storeys, 2):
            # One storey takes [1, 2] as well: stiffness-proportional, so that storeys can
            # vary.
            yield of_value(
                "superstructure.damping.modes",
                f" = {shown(modes)} must be from 1 to {STOREYS} ="
                f" {building.storeys}{self._where(STOREYS)}; a building has as many"
                " modes as storeys",
            )
        if building.vertical_damping is not None and building.vertical_period is None:
            text = (
                " needs superstructure.vertical_period, which is missing; give it, or"
                " remove"
            )
            yield at_key("superstructure.vertical_damping", f"{text} the key")
        text = "ratio, F_1 over V_st, or the shears at which storeys yield"
        yield from _one_of(YIELD, building.yields, text, "ratio", "shears")
        yield from self._stiffnesses(building)
        yield from self._one_each(YIELD, building.yields, "shears")

    def _stiffnesses(self, building: SuperstructureSection) -> Iterator[Fault]:
        """Each direction has stiffnesses or a period, and a value for each storey."""
        for owner, section in (
            ("superstructure", building),
            ("superstructure.y", building.y),
        ):
            if section is None:
                continue
            if section.stiffness is None and section.period is None:
                yield at_key(
                    owner, " has no stiffness: give period (with profile), or stiffness"
                )
            for key in _given(section, f"{owner}.period", f"{owner}.profile"):
                if section.stiffness is not None:
                    yield self._both(
                        f"{owner}.stiffness", key, "fix the storey stiffnesses"
                    )
            yield from self._one_each(
                owner, section, "storey_mass", "storey_height", "stiffness"
            )

    def _one_each(self, owner: str, section: object, *names: str) -> Iterator[Fault]:
        """Lists have one value a storey."""
        storeys = self.file.superstructure.storeys
        for name in names:
            values = getattr(section, name, None)
            if isinstance(values, tuple) and len(values) != storeys:
                yield of_value(
                    f"{owner}.{name}",
                    f" has {len(values)} values, but {STOREYS} ="
                    f" {storeys}{self._where(STOREYS)}; give one value a storey from the"
                    " bottom, or a single value",
                )

    def _masses_under_building(self) -> Iterator[Fault]:
        """Cap beam and columns each have one mass."""
        podium = self.file.podium
        for what, keys in {
            "the mass of the cap beam": (ETA, BEAM),
            "the mass of the columns": (GAMMA, COLUMN_MASS),
        }.items():
            given = _given(podium, *keys)
            if not given:
                names = listed(key.rpartition(".")[2] for key in keys)
                yield at_key("podium", f" leaves {what} open: give {names}")
            elif len(given) > 1:
                yield self._twice(what, given)
        yield from self._number_of_columns()
        for key, value in (
            (GAMMA, podium.cap_beam_mass_ratio),
            (BEAM, podium.cap_beam_mass),
        ):
            if value == 0.0:
                yield of_value(
                    key,
                    f" = 0 must be > 0: the superstructure{self._where(STOREYS)} stands"
                    f" on the cap beam; 0 is for free-standing columns, with {STOREYS}:"
                    " 0",
                )

    def _masses_of_frame(self) -> Iterator[Fault]:
        """Without a building two of three: beam mass, column mass, and their ratio."""
        podium = self.file.podium
        keys = (BEAM, GAMMA, COLUMN_MASS)
        given = _given(podium, *keys)
        if podium.superstructure_mass_ratio is not None:
            text = (
                f" has no meaning with {STOREYS} = 0{self._where(STOREYS)}; give {BEAM}"
                " instead"
            )
            yield at_key(ETA, text)
        elif len(given) > 2:
            yield self._twice("the masses of cap beam and columns", given)
        elif podium.without_cap_beam and (
            podium.cap_beam_mass_ratio or podium.cap_beam_mass
        ):
            yield of_value(
                BEAM,
                f" and {GAMMA}{self._where(GAMMA)} contradict each other: one says that"
                " there is no cap beam; give column_mass instead of one of them",
            )
        elif podium.without_cap_beam:
            if podium.column_mass is None:
                yield at_key(
                    COLUMN_MASS, " is missing: without a cap beam it is the only mass"
                )
        else:
            if len(given) < 2:
                others = listed(
                    key.rpartition(".")[2] for key in keys if key not in given
                )
                text = " leaves the masses of cap beam and columns open: give"
                text += (
                    f" {'one' if given else 'two'} of {others} (column_mass with columns)"
                )
                yield at_key("podium", text)
            yield from self._number_of_columns()

    def _number_of_columns(self) -> Iterator[Fault]:
        if self.file.podium.column_mass is not None and self.file.podium.columns is None:
            yield at_key(
                COLUMNS, " is missing: the number of columns, each of column_mass"
            )

    def _twice(self, what: str, given: list[str]) -> Fault:
        """Point at the last one written and name the places of the others."""
        *others, last = sorted(
            given, key=lambda key: self.document.key_place(path_of(key)).order
        )
        told = listed((f"{key}{self._where(key)}" for key in others), "and")
        both = "both" if len(given) == 2 else "together"
        return at_key(last, f" and {told} {both} fix {what}; remove one of them")

    def _bearing(self) -> Iterator[Fault]:
        """One description of the column, and a complete one."""
        bearing = self.file.podium.bearing
        sizes = self.file.podium.bearing.dimensions
        ratios = _given(bearing, *RATIOS)
        if sizes is None and not ratios:
            names = listed(RATIOS, "and")
            yield at_key(BEARING, f" has no shape: give {names}, or dimensions")
        elif sizes is None:
            optional = [] if bearing.curvature_ratio else ["wedge_slenderness"]
            for name, meaning in RATIOS.items():
                if name not in (*ratios, *optional):
                    yield at_key(f"{BEARING}.{name}", f" is missing: {meaning}")
        elif ratios:
            said = DIMENSIONS, "describe the column", "the ratios or the dimensions"
            yield from (self._both(f"{BEARING}.{name}", *said) for name in ratios)
        elif sizes.wedge_width is None and sizes.radius:
            meaning = "2B', across the outer edges of the arcs; only flat ends need none"
            yield at_key(f"{DIMENSIONS}.wedge_width", f" is missing: {meaning}")

    def _without_effect(self) -> Iterator[Fault]:
        """A measured restitution has no loss; ends without impacts
        have nothing to say of them.
        """
        podium = self.file.podium
        ends = ""
        if podium.impact.law == "value" and podium.impact.loss not in (None, 1.0):
            yield at_key(
                "podium.impact.loss",
                " does not go with law value: a measured restitution includes the loss;"
                " remove it, or scale the restitution by factor",
            )
        idle: list[tuple[str, Section]] = [("podium.impact.contact_time", podium.impact)]
        if podium.contact.kind != "rigid":
            ends = (
                f"with podium.contact{self._where('podium.contact.kind')}: compliant ends"
                " do not"
            )
            ends += " bounce"
            idle.append(("analysis.recontact_tolerance", self.file.analysis))
        elif podium.bearing.slenderness == 0.0:
            ends = (
                f"without a flat part{self._where(f'{BEARING}.slenderness')}: such ends"
                " roll"
            )
            ends += " through upright without an impact"
        for key, section in idle if ends else ():
            # The default may stand there, in a case that was written out whole.
            name = key.rpartition(".")[2]
            if getattr(section, name) != type(section).model_fields[name].default:
                yield at_key(key, f" has no effect {ends}; remove it")

    def _devices(self) -> Iterator[Fault]:
        """Each device has the keys that its kind needs, and none of another kind."""
        for index, device in enumerate(self.file.podium.devices):
            owner = f"podium.devices.{index}"
            keys = type(device).model_fields
            own = tuple(key for key, field in keys.items() if field.is_required())
            needed, optional = DEVICE_KEYS.get(device.kind, (own, ()))
            given = _given(device, *keys)
            for key in (key for key in needed if key not in given):
                meaning = DeviceSection.model_fields[key].description
                yield at_key(f"{owner}.{key}", f" is missing: {meaning}")
            for key in (key for key in given if key not in ("kind", *needed, *optional)):
                known = listed((*needed, *optional), "and")
                text = (
                    f" is not a key of kind: {device.kind}, which has {known}; remove it"
                )
                yield at_key(f"{owner}.{key}", text)
        kinds = [DEVICES.get(each.kind) for each in self.file.podium.devices]
        of_columns = [i for i, kind in enumerate(kinds) if kind and kind.in_each_column]
        if of_columns and self.file.podium.columns is None:
            text = f" is in each column, but {COLUMNS}, their number, is missing"
            yield of_value(f"podium.devices.{of_columns[0]}", text)

    def _record(self) -> Iterator[Fault]:
        """A record has a factor, or a measure that fixes it; a
        pair is said in one way.
        """
        record = self.file.record
        if record is None:
            return
        if record.x is not None and self.document.has(("record", "source")):
            yield self._both("record.x", "record.source", "name the first component")
        if record.x is not None and record.y is None:
            meaning = "the second component beside x; one alone is a source"
            yield at_key("record.y", f" is missing: {meaning}")
        both = record.y is not None
        for name in _given(record, "source" if record.x is None else "x", "y"):
            try:
                source = Source.parse(getattr(record, name))
            except RecordError as error:
                yield of_value(f"record.{name}", f": {error}")
                continue
            if record.y is not None and source.of_pair:
                text = (
                    " names a pair or a direction between two components; name single"
                    " components"
                )
                yield of_value(
                    f"record.{name}", f"{text} here, or leave y out and write `?both`"
                )
            both = both or source.both
        if record.rotation is not None and not both:
            text = " turns a pair: give y as well, or write `?both` behind the source"
            yield at_key(
                "record.rotation", f"{text}; angle= is one direction between two"
            )
        if record.scale_to is not None and record.scale != 1.0:
            yield self._both("record.scale_to", "record.scale", "fix the factor")

    def _columns(self) -> Iterator[Fault]:
        """Rows have heights for the moment of the building; the
        force of one column a number.
        """
        podium = self.file.podium
        building = self.file.superstructure
        if podium.column is not None and podium.columns is None:
            yield at_key(COLUMNS, f" is missing: {COLUMN} asks for the force of one")
        text = "length, between two rows of columns, or the places of all rows"
        yield from _one_of("podium.plan", podium.plan, text, "length", "rows")
        yield from _one_of(
            "podium.plan.y", podium.plan and podium.plan.y, text, "length", "rows"
        )
        if podium.plan is not None and (number := podium.columns) is not None:
            x = len(rows_of(podium.plan))
            y = len(rows_of(podium.plan.y))
            if y and number != x * y:
                of_rows = (
                    f"must be {x} x {y}: one stands wherever two rows of podium.plan"
                    " cross"
                )
                yield of_value(COLUMNS, f" = {number} {of_rows}")
            elif number % x:
                of_rows = (
                    f"cannot stand in {x} rows of podium.plan with equally many each"
                )
                yield of_value(COLUMNS, f" = {number} {of_rows}")
        if (
            podium.plan is not None
            and building.storeys
            and building.storey_height is None
        ):
            yield at_key("podium.plan", f" needs {HEIGHT}: the moment has lever arms")

    def faults_of_bearing(self, bearing: Bearing) -> Iterator[Fault]:
        """Strengths that its ends do not have, and rotations beyond the model."""
        file = self.file
        analysis = self.file.analysis
        critical = bearing.critical_rotation
        yields = file.superstructure.yields
        if bearing.is_spherical and yields is not None and yields.ratio is not None:
            text = (
                ": columns without a flat part have no V_st; give the shears in place of"
                " a ratio"
            )
            yield at_key(f"{YIELD}.ratio", text)
        most = bearing.largest_rotation / critical
        if analysis.overturning_limit > most:
            yield of_value(
                "analysis.overturning_limit",
                f" = {analysis.overturning_limit:g} times theta_cr = {critical:.6g} rad"
                f" must not exceed {bearing.largest_rotation:.6g} rad, where the columns"
                " lie down and the model ends; use at most"
                f" {math.floor(1e3 * most) / 1e3:g}",
            )
        limit = overturning_limit(analysis, bearing) * critical
        if abs(analysis.initial_rotation) >= limit:
            yield of_value(
                "analysis.initial_rotation",
                f" = {analysis.initial_rotation:g} rad must stay below the overturning"
                f" limit, {limit:.6g} rad (overturning_limit * theta_cr, or less); use a"
                " smaller one",
            )
