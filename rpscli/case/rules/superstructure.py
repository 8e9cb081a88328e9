"""What the keys of `superstructure`, `limits` and `record`, and the masses must be together."""

from __future__ import annotations

from collections.abc import Iterator

from rpscli.analyses.result_quantities import LIMITED
from rpscli.case.rules.partial_case import LIMITS, PLAN, PODIUM, SUPERSTRUCTURE, PartialCase
from rpscli.case.text.document import MISSING, Fault, Path, dotted, shown
from rpscli.errors import RecordError, listed
from rpscli.records.source import Source

STOREYS: Path = (*SUPERSTRUCTURE, "storeys")
ACROSS: Path = (*SUPERSTRUCTURE, "y")
VERTICAL_PERIOD: Path = (*SUPERSTRUCTURE, "vertical_period")
BUILDING_KEYS = (
    "storey_mass",
    "storey_height",
    "period",
    "profile",
    "stiffness",
    "damping",
    "vertical_period",
    "y",
)


def superstructure_rules(case: PartialCase) -> Iterator[Fault]:
    """A building needs masses, stiffness and damping, each given once."""
    if not case.storeys:
        return
    meaning = "floor mass, one value or a list from the bottom, as in '200 t'"
    yield from case.missing((*SUPERSTRUCTURE, "storey_mass"), meaning)
    meaning = "as in {ratio: 0.05, modes: [1, 2]} (Rayleigh) or {ratio: 0.05} (every mode)"
    yield from case.missing((*SUPERSTRUCTURE, "damping"), meaning)
    for path in (SUPERSTRUCTURE, ACROSS):
        if path == SUPERSTRUCTURE or case.is_mapping(path):
            yield from _stiffness(case, path)
            yield from _list_lengths(case, path)
    yield from _modes(case)


def _stiffness(case: PartialCase, owner: Path) -> Iterator[Fault]:
    whose = dotted(owner)
    period, profile, stiffness = ((*owner, n) for n in ("period", "profile", "stiffness"))
    if not case.has(stiffness) and not case.has(period):
        text = f"{whose} has no stiffness: give period (with profile), or stiffness"
        yield Fault(owner, text, at_key=True, needs=(period, stiffness))
    for path, name in ((period, "period"), (profile, "profile")):
        if case.document.has(stiffness) and case.document.has(path):
            both = f"{whose}.stiffness and {whose}.{name}{case.where(path)}"
            text = f"{both} both fix the storey stiffnesses; keep one of them"
            yield Fault(stiffness, text, at_key=True)


def _list_lengths(case: PartialCase, owner: Path) -> Iterator[Fault]:
    section = case.superstructure if owner == SUPERSTRUCTURE else case.across
    for name in ("storey_mass", "storey_height", "stiffness"):
        values = getattr(section, name, None)
        if isinstance(values, tuple) and len(values) != case.storeys:
            yield Fault(
                (*owner, name),
                f"{dotted((*owner, name))} has {len(values)} values, but superstructure.storeys ="
                f" {case.storeys}{case.where(STOREYS)}; give one value a storey from the bottom,"
                " or a single value",
            )


def _modes(case: PartialCase) -> Iterator[Fault]:
    damping = case.superstructure.damping if case.superstructure else None
    storeys = case.storeys or 0
    # One storey takes [1, 2] as well: stiffness-proportional, so that a study can vary storeys.
    if damping and damping.modes and max(damping.modes) > max(storeys, 2):
        yield Fault(
            (*SUPERSTRUCTURE, "damping", "modes"),
            f"superstructure.damping.modes = {shown(damping.modes)} must be from 1 to"
            f" superstructure.storeys = {storeys}{case.where(STOREYS)}; a building has as many"
            " modes as storeys",
        )


def limits_rules(case: PartialCase) -> Iterator[Fault]:
    """A limit on something that the case cannot give would never be exceeded."""
    if case.storeys == 0:
        of_buildings = (q.name for q in LIMITED if "superstructure" in q.needs)
        for name in case.present(LIMITS, *of_buildings):
            text = f"needs a building, but superstructure.storeys = 0{case.where(STOREYS)}"
            fault = f"limits.{name} {text}; remove the limit"
            yield Fault((*LIMITS, name), fault, at_key=True)
    height = (*SUPERSTRUCTURE, "storey_height")
    if case.storeys and case.has((*LIMITS, "drift_ratio")) and not case.has(height):
        text = "limits.drift_ratio needs superstructure.storey_height, which is missing"
        yield Fault((*LIMITS, "drift_ratio"), text, at_key=True, needs=(height,))


def column_rules(case: PartialCase) -> Iterator[Fault]:
    """Rows of columns are complete, and limits on the force of a column are on all of it."""
    plan, height = PLAN, (*SUPERSTRUCTURE, "storey_height")
    if case.has(plan):
        given = case.present(plan, "length", "rows")
        if len(given) != 1:
            text = "give length, between two rows of columns, or the places of all rows"
            yield Fault(plan, f"podium.plan: {text}; not {'both' if given else 'neither'}")
        rows = case.plan and case.plan.rows
        if rows is not None and len(set(rows)) < 2:
            written = shown(case.document.at((*plan, "rows")))
            text = f"podium.plan.rows = {written} must be two or more different positions"
            yield Fault((*plan, "rows"), f"{text}, as in [0, 4 m, 8 m]")
        if case.storeys and not case.has(height):
            text = "podium.plan needs superstructure.storey_height: the moment has lever arms"
            yield Fault(plan, text, at_key=True, needs=(height,))
    keys = {"the overturning moment": plan, "the shock of impacts": VERTICAL_PERIOD}
    lacking = {what: path for what, path in keys.items() if not case.has(path)}
    for name in case.present(LIMITS, "max_column_force", "min_column_force"):
        if case.storeys and lacking:
            yield Fault(
                (*LIMITS, name),
                f"limits.{name}: the force of a column is known without"
                f" {listed(lacking, 'and')} only, and may be several times as large with it; give"
                f" {listed(('.'.join(map(str, path)) for path in lacking.values()), 'and')}",
                at_key=True,
                needs=tuple(lacking.values()),
            )


def ignored_text(case: PartialCase) -> str:
    """The warning about keys of a building that have no effect because there is none."""
    names = case.present(SUPERSTRUCTURE, *BUILDING_KEYS)
    if case.storeys != 0 or not names:
        return ""
    keys = listed((f"superstructure.{name}" for name in names), "and")
    return f"superstructure.storeys = 0: there is no building, so {keys} had no effect"


GAMMA, ETA = "cap_beam_mass_ratio", "superstructure_mass_ratio"
BEAM, COLUMN, COLUMNS = "cap_beam_mass", "column_mass", "columns"


def masses_rules(case: PartialCase) -> Iterator[Fault]:
    """Cap beam and columns each have one mass."""
    if case.storeys is None or not case.is_mapping(PODIUM):
        return
    if case.storeys:
        yield from _one_of(case, "the mass of the cap beam", ETA, BEAM)
        yield from _one_of(case, "the mass of the columns", GAMMA, COLUMN)
        yield from _number_of_columns(case)
        for name in (GAMMA, BEAM):
            if case.masses and getattr(case.masses, name) == 0.0:
                yield Fault(
                    _path(name),
                    f"podium.{name} = 0 must be > 0: the superstructure{case.where(STOREYS)} stands"
                    " on the cap beam; 0 is for free-standing columns, with"
                    " superstructure.storeys: 0",
                )
    else:
        yield from _frame(case)


def _path(name: str) -> Path:
    return (*PODIUM, name)


def _one_of(case: PartialCase, what: str, *names: str) -> Iterator[Fault]:
    given = case.present(PODIUM, *names)
    if not given:
        needs = tuple(map(_path, names))
        text = f"podium leaves {what} open: give {listed(names)}"
        yield Fault(PODIUM, text, at_key=True, needs=needs)
    written = case.written(PODIUM, *names)
    if len(written) > 1:
        yield _twice(case, what, written)


def _twice(case: PartialCase, what: str, given: list[str]) -> Fault:
    """Point at the last one written and name the places of the others."""
    order = [(case.document.key_place(_path(name)), name) for name in given]
    *others, last = [n for _, n in sorted(order, key=lambda o: (o[0].rank, o[0].line, o[0].column))]
    named = listed((f"podium.{name}{case.where(_path(name))}" for name in others), "and")
    both = "both" if len(others) == 1 else "together"
    text = f"podium.{last} and {named} {both} fix {what}; remove one of them"
    return Fault(_path(last), text, at_key=True)


def _number_of_columns(case: PartialCase) -> Iterator[Fault]:
    if case.has(_path(COLUMN)):
        yield from case.missing(_path(COLUMNS), "the number of columns, each of column_mass")


def _frame(case: PartialCase) -> Iterator[Fault]:
    """Without a building two of three: beam mass, column mass, and their ratio."""
    if case.has(_path(ETA)):
        yield Fault(
            _path(ETA),
            f"podium.{ETA} has no meaning with superstructure.storeys = 0{case.where(STOREYS)};"
            f" give podium.{BEAM} instead",
            at_key=True,
        )
        return
    masses, given = case.masses, case.present(PODIUM, BEAM, GAMMA, COLUMN)
    written = case.written(PODIUM, BEAM, GAMMA, COLUMN)
    if len(written) > len((BEAM, COLUMN)):
        yield _twice(case, "the masses of cap beam and columns", written)
    elif (
        masses and masses.without_cap_beam and (masses.cap_beam_mass_ratio or masses.cap_beam_mass)
    ):
        yield Fault(
            _path(BEAM),
            f"podium.{BEAM} and podium.{GAMMA}{case.where(_path(GAMMA))} contradict each other:"
            " one says that there is no cap beam; give column_mass instead of one of them",
        )
    elif masses and masses.without_cap_beam:
        yield from case.missing(_path(COLUMN), "without a cap beam it is the only mass")
    else:
        if len(given) < 2:
            open_names = [name for name in (BEAM, GAMMA, COLUMN) if name not in given]
            number = "one" if given else "two"
            text = f"podium leaves the masses of cap beam and columns open: give {number} of"
            text += f" {listed(open_names)} (column_mass with columns)"
            yield Fault(PODIUM, text, at_key=True, needs=tuple(map(_path, open_names)))
        yield from _number_of_columns(case)


SCALE: Path = ("record", "scale")
SCALE_TO: Path = ("record", "scale_to")
SOURCE, X, Y, ROTATION = ((("record", name)) for name in ("source", "x", "y", "rotation"))


def record_rules(case: PartialCase) -> Iterator[Fault]:
    """A record has a factor, or a measure that fixes the factor; a pair is said in one way."""
    yield from _pair_rules(case)
    written = case.document.at(SCALE)
    if case.document.has(SCALE_TO) and written is not MISSING and written != 1.0:
        text = f"record.scale_to and record.scale{case.where(SCALE)} both fix the factor"
        yield Fault(SCALE_TO, f"{text}; keep one of them", at_key=True)


def _pair_rules(case: PartialCase) -> Iterator[Fault]:
    """Two components have two sources, or one that says `both`; only they are rotated."""
    if case.document.has(X):
        if case.document.has(SOURCE):
            text = f"record.x and record.source{case.where(SOURCE)} both name the first component"
            yield Fault(X, f"{text}; keep one of them", at_key=True)
        yield from case.missing(Y, "the second component beside x; one alone is a source")
    first = X if case.document.has(X) else SOURCE
    pair = case.document.has(Y)
    for path in (first, Y):
        try:
            of = Source.parse(str(case.document.at(path)))
        except RecordError as error:
            yield Fault(path, f"{dotted(path)}: {error}")
            continue
        if case.document.has(Y) and of.of_pair:
            text = "names a pair or a direction between two components; name single components here"
            yield Fault(path, f"{dotted(path)} {text}, or leave y out and write `?both`")
        pair = pair or of.both
    if case.document.has(ROTATION) and not pair:
        text = "record.rotation turns a pair: give y as well, or write `?both` behind the source"
        yield Fault(ROTATION, f"{text}; angle= is one direction between two", at_key=True)
