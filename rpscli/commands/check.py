"""`rps check`: what follows from a case, before any analysis."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Any

import click

from rpscli.case.conditions import (
    Condition,
    case_conditions,
    conditions_of,
    unknown_of_pairs,
)
from rpscli.commands import inputs
from rpscli.commands.shell import options
from rpscli.errors import CaseError, RecordError, RpsError, UsageError
from rpscli.report.derived import (
    AT_CRITICAL,
    BOTH,
    COLUMN,
    CONTACT,
    DYNAMICS,
    FIRST_PERIOD,
    GEOMETRY,
    UPWARDS,
    Derived,
    derived_quantities,
    label_of,
    strength_tables,
    strengths_by_way,
    twist_texts,
)
from rpscli.report.files import heading
from rpscli.report.table import Heading, Part, Table, large, shown

if TYPE_CHECKING:
    from rpscli.case.case import Case
    from rpscli.model.podium import PodiumStructure

_BY_NAME = {row.name: row for row in (*GEOMETRY, *DYNAMICS)}
LEADING = (
    _BY_NAME["initial_stiffness"],
    _BY_NAME["critical_rotation"],
    *AT_CRITICAL,
    _BY_NAME["static_base_shear"],
)
"""What is asked of every case, and stands first."""
RECORD = ("name", "source", "format", "description", "npts", "dt", "duration", "pga")
"""Properties of a ground motion in the document."""


@click.command("check")
@options.case_options
@options.direction_option
@click.option(
    "--draw",
    is_flag=True,
    help=(
        "Also draw the bearing with its dimensions: at rest, where rolling ends, at the"
        " critical rotation, and the restoring force; the figure bearing."
    ),
)
@options.result_options
def command(
    request: options.CaseRequest,
    out: options.Output,
    *,
    direction: str,
    draw: bool,
) -> None:
    """What follows from CASE: geometry, masses, statics, periods.

    Nothing is analysed, and nothing is written without --draw. A case with mistakes ends
    with exit code 3 and a line for each of them; so does a record that cannot be read.
    """
    if not draw and (out != options.Output(out.terminal)):
        raise UsageError(
            "only --draw writes something; options of files and figures go with it"
        )
    given = inputs.read_case(request, out.terminal)
    structure = given.seen(direction)
    title = given.titled(direction)
    record, error = _record(given.case)
    doubts = [*_of_yielding(structure), *(record["warnings"] if record else [])]
    document = {
        **heading("check"),
        "case": inputs.case_heading(given),
        "direction": direction,
        **_derived(structure),
        "record": record,
        "limits": given.case.limits.model_dump(exclude_none=True),
        "warnings": [*given.case.warnings, *doubts],
    }
    if draw:
        from rpscli.report.bundles import bearing_files

        folder = inputs.direction_folder(given, out, "check", direction)
        folder.add_all(bearing_files(structure, title, out.look))
        inputs.write(folder, out.terminal)
        document["files"] = folder.files
    out.terminal.warn(doubts)
    limits = case_conditions(given.case.limits, given.case.structure)
    others = _further_tables(structure, document)
    other = ["in the direction x; --direction y shows the other"]
    other *= direction == "x" and structure.superstructure_y is not None
    unknown = _unknown(structure, record)
    tables = chain(check_tables(document, title, limits, unknown), others, other)
    out.terminal.finish(document, tables, error)


def _of_yielding(structure: PodiumStructure) -> Iterable[str]:
    """Warnings of a building whose storeys yield when it is pushed."""
    if not structure.yields:
        return ()
    from rpscli.analyses.pushover import pushover  # one that most cases do without

    return pushover(structure).warnings


def _derived(structure: PodiumStructure) -> dict[str, Any]:
    """Derived quantities, those of devices and the strengths of storeys, for JSON."""
    from rpscli.model.statics import device_consequences, wind_on

    derived = derived_quantities(structure) | device_consequences(structure)
    wind = wind_on(structure)
    derived["wind"] = wind and {**wind._asdict(), "moves": wind.moves}
    for way, strengths in strengths_by_way(structure).items():
        derived[f"storey_strengths{way}"] = [each._asdict() for each in strengths]
    return derived


def _record(case: Case) -> tuple[dict[str, Any] | None, RpsError | None]:
    """The case's own record, and why it cannot be read or goes with no limit of the case;
    nothing if the case names none.
    """
    from rpscli.case.plausibility import doubts_of_motion

    if case.record is None:
        return None, None
    try:
        motion = inputs.load_motion(case, inputs.MotionRequest())
    except (RecordError, CaseError) as error:
        return None, error
    found = motion.horizontal
    both = motion.y is not None
    warnings = [*found.warnings, *motion.warnings]
    doubts = [str(doubt) for doubt in doubts_of_motion(case.structure, motion)]
    limits = conditions_of(case.limits, "limits of the case")
    unknown = unknown_of_pairs(limits, case.structure) if both else []
    known = {name: getattr(found, name) for name in RECORD}
    y = motion.y
    across = y and {name: getattr(y, name) for name in RECORD}
    return {
        **known,
        "y": across,
        "scale": motion.scale,
        "warnings": [*warnings, *doubts],
    }, CaseError("\n".join(unknown)) if unknown else None


def _unknown(
    structure: PodiumStructure, record: dict[str, Any] | None
) -> Collection[str]:
    """Derived quantities that a history under the record of the case will not give."""
    from rpscli.analyses.column_design import no_line  # numpy is slow

    both = record is not None and record["y"] is not None
    return (
        ("contact_rest_pressure", "crushed_rest_ratio")
        if no_line(structure, both=both)
        else ()
    )


def check_tables(
    document: Mapping[str, Any],
    title: str,
    limits: Sequence[Condition],
    unknown: Collection[str] = (),
) -> Iterator[Part]:
    """Leading quantities; geometry; masses, statics, periods; the record; the limits."""
    yield Heading(title)
    pair = document["record"] and document["record"]["y"]
    dynamics = (*DYNAMICS, FIRST_PERIOD, *UPWARDS, *CONTACT)
    for rows in (LEADING, GEOMETRY, dynamics, COLUMN, BOTH if pair else ()):
        known = [each for each in rows if each.name not in unknown]
        if rows is LEADING:
            texts = [*_quantity_rows(document, known), *_stiffness_rows(document)]
        else:
            further = [each for each in known if each not in LEADING]
            texts = [*_quantity_rows(document, further)]
        if texts:
            yield Table.of_texts(("", "symbol", "value", "unit"), texts, words=2)
    if document["record"]:
        yield _record_table(document["record"])
    if limits:
        from rpscli.report.limits import requirement_text

        asked = [(each.name, requirement_text(each)) for each in limits]
        yield Table.of_texts(("limit", ""), asked, words=2)


def _quantity_rows(
    document: Mapping[str, Any], quantities: Iterable[Derived]
) -> Iterator[tuple[str, str, str, str]]:
    """Label, symbol, value and unit of the quantities that the document has."""
    for row in quantities:
        if row.name not in document or row.name.endswith("_paper"):
            continue
        if not (label := label_of(row, document)):
            continue
        of_some = row in (*CONTACT, *COLUMN, *BOTH) or row.name == "rolling_period"
        if document[row.name] is None and of_some:
            continue  # columns with a flat part, edges, or curved ends have none
        value, unit = large(document[row.name], row.unit)
        yield label, row.symbol, shown(value), unit


def _stiffness_rows(
    document: Mapping[str, Any],
) -> Iterator[tuple[str, str, str, str]]:
    """Stiffnesses of the lowest and of the highest storey."""
    given = document["stiffnesses"]
    roof = "roof (see profile)" if given[-1:] > given[:1] else "roof"
    ends = zip(("bottom", roof), (*given[:1], *given[1:][-1:]), strict=False)
    for name, stiffness in ends:
        yield f"storey stiffness, {name}", "", shown(1e-3 * stiffness), "kN/m"


def _record_table(record: Mapping[str, Any]) -> Table:
    """The record of the case: its name, samples and peaks."""
    y = record["y"]
    samples = f"{record['npts']} at {record['dt']:g} s, {shown(record['duration'])} s"
    return Table.listing([
        ("record", record["name"]),
        ("", record["description"]),
        ("format", record["format"]),
        ("samples", samples),
        ("peak acceleration", f"{shown(record['pga'])} m/s2"),
        *([("in y", f"{y['name']}, {shown(y['pga'])} m/s2")] if y else []),
        ("scale", f"{record['scale']:g}"),
    ])  # fmt: skip


def _further_tables(
    structure: PodiumStructure, document: Mapping[str, Any]
) -> Iterator[Part]:
    """Of the wind, of devices, of storeys that yield."""
    yield from twist_texts(structure)
    yield from wind_table(document["wind"])
    yield from device_tables(structure, document)
    yield from strength_tables(structure)


def wind_table(wind: Mapping[str, Any] | None) -> Iterator[Part]:
    """The base shear of the wind beside the force that moves the cap beam."""
    if wind is None:
        return
    forces = [
        ("base shear of the wind", "V_w", wind["base_shear"]),
        ("uplift force at the cap beam", "W tan(alpha)", wind["uplift_force"]),
        ("friction while columns stand upright", "", wind["friction"]),
        ("force that moves the cap beam, with devices", "", wind["moving_force"]),
    ]
    rows = [(name, symbol, shown(1e-3 * value), "kN") for name, symbol, value in forces]
    if wind["ratio"] is not None:
        rows.append(("wind over that force", "", shown(wind["ratio"]), ""))
    yield Table.of_texts(("wind", "symbol", "value", "unit"), rows, words=2)
    yield "the wind MOVES the building" if wind["moves"] else "the wind moves nothing"


def device_tables(
    structure: PodiumStructure, document: Mapping[str, Any]
) -> Iterator[Part]:
    """Each device's numbers, uplift with all of them, and from
    where the podium re-centres.
    """
    if not structure.devices:
        return
    rows = []
    for device, label, value, unit in _of_devices(structure, document):
        number, name = large(value, unit)
        rows.append((device, label, "never" if number is None else shown(number), name))
    if rows:
        yield Table.of_texts(("device", "", "value", "unit"), rows, words=2)
    if not (back := document["recentring"]):
        return
    swings = []
    for row in back:
        forces = (shown(1e-3 * row[name]) for name in ("friction", "largest_friction"))
        share = shown(row["rotation"] / structure.critical_rotation, 2)
        way = shown(row["rotation"]), share, shown(row["displacement"])
        swings.append((*way, *forces, _end_of_return(row)))
    heads = (
        "from rest at rad",
        "of theta_cr",
        "u_b m",
        "friction kN",
        "at most kN",
        "comes back",
    )
    yield Table.of_texts(heads, swings)
    yield from _about_returns(back)


def _of_devices(
    structure: PodiumStructure, document: Mapping[str, Any]
) -> Iterator[tuple[str, str, float | None, str]]:
    """Devices, counted from 1, with their numbers, and those of all together."""
    for number, device in enumerate(structure.devices, 1):
        for item in device.consequences(structure):
            yield f"{number} {device.kind}", item.label, item.value, item.unit
    begins = "uplift force at the cap beam", "uplift acceleration, quasi-static"
    if structure.bearing.is_spherical:
        begins = "force at the cap beam that moves it", "acceleration that moves it"
    yield "all", begins[0], document["uplift_force_with_devices"], "N"
    yield "all", begins[1], document["uplift_acceleration_with_devices"], "m/s2"


def _end_of_return(row: Mapping[str, Any]) -> str:
    """Words for whether the storey comes back, or how far from upright it stays."""
    if row["recentres"]:
        return "yes"
    rest = row["rest"]
    if rest is None:
        band = row["dead_band"]
        near = band is not None and band < row["displacement"]
        return f"to {shown(1e3 * band, 3)} mm or less" if near else "no"
    if rest >= row["displacement"]:
        return "no, it stays"
    return f"to {shown(1e3 * abs(rest), 3)} mm"


def _about_returns(back: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    """Meaning of the columns, and where friction holds the storey."""
    text = (
        "at most: the largest friction against which it would come back upright from"
        " there, slowly"
    )
    band = back[0]["dead_band"]
    if band:
        text += (
            f"; friction holds it at rest within {shown(1e3 * band)} mm of upright, where"
            " friction is the restoring force, F_d/K"
        )
    if band is None:
        text += "; friction holds it at rest wherever it stands still"
    elif back[0]["rest"] is not None:
        text += (
            "; comes back to: where a rigid building stays after its last swing, if"
            " friction alone takes energy"
        )
    yield text
