"""Sections of pages: what a case is, its ground motions, and the
history that was computed.
"""

from __future__ import annotations

import json
import shlex
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from importlib import resources
from typing import Any

import numpy as np

from rpscli.analyses.pushover import pushover
from rpscli.analyses.results import STEEL_ROTATION, TimeHistoryResult
from rpscli.case.case import Case
from rpscli.case.schema.keys import unit
from rpscli.case.text.yaml_text import yaml_of
from rpscli.errors import listed
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import Superstructure
from rpscli.records.ground_motion import GroundMotion, MotionComponents
from rpscli.records.measures import DAMPING, drawn_spectrum, intensity_measures
from rpscli.report import derived, timehistory
from rpscli.report.captions import CAPTIONS, NOT_OF_A_RESPONSE
from rpscli.report.column_table import column_table
from rpscli.report.figures import style
from rpscli.report.figures.look import Look
from rpscli.report.figures.motions import draw_spectra, record_figure
from rpscli.report.figures.plan import ColumnPlan, draw_plan
from rpscli.report.figures.structure import bearing_figure, draw_structure
from rpscli.report.files import leaves, versions
from rpscli.report.limits import doubt_texts, limits_table, verdicts_in_short
from rpscli.report.motions import record_table
from rpscli.report.page import (
    Attachment,
    Block,
    Listing,
    Notice,
    Picture,
    ReportSection,
    page_look,
    pictures,
)
from rpscli.report.table import PAGE_UNITS, Column, Table, large
from rpscli.report.twist import twist_parts
from rpscli.sweep.statistics.verdicts import Verdict

MOST_ROWS = 100
MOST_SPECTRA = 200


def motion_pictures(
    motion: GroundMotion, look: Look, building: Superstructure | None = None
) -> Picture:
    """Acceleration, velocity, displacement and response spectrum of a motion, with T1."""
    period = None if building is None else float(building.periods[0])
    caption = (
        f"{motion.name}: acceleration, velocity and displacement of the ground, and the"
        f" response spectrum at {style.percent(DAMPING)} of critical damping."
    )
    draw = partial(record_figure, motion, drawn_spectrum(motion), period)
    return _picture(draw, look, caption)


def _picture(draw: style.Draw, look: Look, caption: str) -> Picture:
    files = style.figure_files({"figure": draw}, page_look(look))
    return Picture({each.ending: each for each in files.values()}, caption)


def motions_section(
    motions: Sequence[GroundMotion],
    unreadable: Sequence[str],
    title: str,
    look: Look,
    which: str = "before they are scaled",
    names: Sequence[str] = (),
) -> ReportSection:
    """Records of a study, or of several histories: peaks, digests and spectra.

    With `names` of histories, each record is called by its name, beside its source.
    """
    blocks: list[Block] = [*unreadable]
    if motions:
        heads = (
            *(("record", "source") if names else ("record",)),
            "SHA-256 begins with",
            "duration [s]",
            "PGA [m/s2]",
            "PGV [m/s]",
        )
        rows = []
        for place, each in enumerate(motions[:MOST_ROWS]):
            of = intensity_measures(each)
            called = (names[place],) if names else ()
            numbers = map("{:.4g}".format, (each.duration, of.pga, of.pgv, of.d5_95))
            rows.append((*called, each.source, each.digest[:16], *numbers))
        words = 2 + bool(names)
        blocks.append(Table.of_texts((*heads, "5-95 % [s]"), rows, words=words))
        spectra = [drawn_spectrum(each) for each in motions[:MOST_SPECTRA]]
        kind = "components" if names else "records"
        caption = (
            f"Response spectra of {len(spectra)} {kind} {which}, at"
            f" {style.percent(DAMPING)} of critical damping, with their median."
        )
        blocks.append(
            _picture(style.single(draw_spectra, spectra, (title,), 3.2), look, caption)
        )
    if len(motions) > MOST_ROWS:
        blocks.append(f"The table shows the first {MOST_ROWS} of {len(motions)} records.")
    return ReportSection("Ground motions", blocks)


DIGITS = 6
THEORY = "THEORY.md"
HIDDEN = (
    "| assumed |"  # begins the table of the theory that says what the model cannot tell
)


def page_sections(
    case: Case,
    title: str,
    look: Look,
    *,
    short: Iterable[Block],
    warnings: Iterable[str],
    inputs: Iterable[Block],
    results: Iterable[ReportSection],
    commands: Iterable[Sequence[str]],
    stored: Iterable[Block],
    both: bool,
    which: Sequence[Block] = (),
) -> list[ReportSection]:
    """All of a page in its order; `which` says of which system
    structure and formulas are.
    """
    structure = case.structure
    podium = case.document["podium"]
    told = [Notice(f"Warning: {text}") for text in warnings]
    repeat: list[Block] = [
        "From the folder in which this page was made, with the same versions:",
        Listing("\n".join(map(shlex.join, commands))),
        *stored,
    ]
    return [
        ReportSection("In short", [*short, *told]),
        ReportSection(
            "The structure", [*which, *structure_blocks(structure, title, look)]
        ),
        ReportSection("Input", [*inputs]),
        ReportSection("Derived quantities", [*which, *derived_blocks(structure, podium)]),
        *results,
        ReportSection(
            "Limits of the model",
            [hidden_table(both=both, turns=structure.twist is not None)],
        ),
        ReportSection("How to repeat it", repeat),
    ]


def listing(rows: Iterable[tuple[str, str]]) -> Table:
    """Rows above the input, and the versions of what made the numbers."""
    made = ", ".join(
        f"{name} {version}" for name, version in versions().items() if version
    )
    return Table.listing([*rows, ("made by", made)])


def structure_blocks(structure: PodiumStructure, title: str, look: Look) -> list[Block]:
    """The drawings, and the storeys."""
    draws: dict[str, style.Draw] = {
        "s": style.single(draw_structure, structure, (title,), 4.4, 5.0),
        "bearing": partial(bearing_figure, pushover(structure, patterns=()), title),
    }
    blocks: list[Block] = [_picture(draws[name], look, CAPTIONS[name]) for name in draws]
    if structure.superstructure is not None:
        blocks += ["Storeys, the roof on top:", _storeys(structure)]
    return blocks


def _storeys(structure: PodiumStructure) -> Table:
    building = structure.superstructure
    assert building is not None, "there are storeys"
    shape = derived.first_shape(building)
    heights = building.storey_heights
    count = building.storeys
    columns = {
        "storey": np.arange(count) + 1,
        "height [m]": [None] * count if heights is None else heights,
        "mass m_i [t]": building.masses * 1e-3,
        "stiffness k_i [kN/m]": building.stiffnesses * 1e-3,
        "first mode φ_i": shape,
    }
    if (across := structure.superstructure_y) is not None:
        columns["stiffness in y [kN/m]"] = across.stiffnesses * 1e-3
    return Table(
        [Column(name, "-", each[::-1], name, _number) for name, each in columns.items()]
    )


def input_table(
    content: Mapping[str, Any], written: Mapping[str, Any] | None = None
) -> Table:
    """Every key of a case in SI units, defaults written out,
    beside what the user wrote.
    """
    rows = [
        (key, _plain(value), unit(key).removeprefix("-"))
        for key, value in leaves(content)
    ]
    if not written:
        return Table.of_texts(("key", "value", "unit"), rows, words=3)
    own = {key: _as_typed(value) for key, value in leaves(written)}
    beside = [(key, own.get(key, ""), *rest) for key, *rest in rows]
    return Table.of_texts(("key", "as written", "value in SI", "unit"), beside, words=4)


def _as_typed(value: object) -> str:
    """A value of the file, lists of texts without their quotes."""
    return (
        f"[{', '.join(map(_as_typed, value))}]"
        if isinstance(value, list)
        else _plain(value)
    )


def derived_blocks(structure: PodiumStructure, podium: Mapping[str, Any]) -> list[Block]:
    """Derived quantities with formulas, and with the numbers put in."""
    text = (
        "The numbers put in are in SI units, angles in radians, rounded to"
        f" {DIGITS} digits; the values follow from unrounded ones, in kN, kN m, MPa and"
        " t where SI has N, N m, Pa and kg. The"
        f" formulas are derived in {THEORY}, sections 1 to 7, 12, 14 and 16. f, κ and"
        " e_given are factor, loss and restitution of podium.impact, I is"
        " podium.bearing.inertia_ratio."
    )
    return [text, _derived(derived.derivations(structure, podium))]


def _derived(found: Iterable[derived.Derivation]) -> Table:
    rows = [
        (
            *row[1:3],
            row.formula or "from the case",
            row.numbers,
            *_in_large_units(row.value, row.unit),
        )
        for row in found
    ]
    heads = ("quantity", "symbol", "formula", "with numbers", "value", "unit")
    return Table.of_texts(heads, rows, words=4)


def _in_large_units(value: float | None, unit: str) -> tuple[str, str]:
    """A value and its unit as checkers read them."""
    number, name = large(value, unit)
    return _number(number), name


REMOVED_BY_TWIST = "does not turn about the vertical", "do not twist"
"""Assumptions of the theory that `podium.twist` removes."""


def hidden_table(*, both: bool, turns: bool = False) -> Table:
    """Limits of the model, in the words of the theory, of one component or of both, and
    of a slab that `turns`.
    """
    text = resources.files("rpscli").joinpath(THEORY).read_text(encoding="utf-8")
    _, plane, space = text.split(f"\n{HIDDEN}")
    heads = []
    rows = []
    for table in (plane, space) if both else (plane,):
        lines = (HIDDEN + table).split("\n\n", 1)[0].splitlines()
        heads, _, *found = (
            [cell.strip() for cell in line.strip("|").split("|")] for line in lines
        )
        rows += [row for row in found if not (both and row[0] == "plane motion")]
    if turns:
        rows = [row for row in rows if not row[0].endswith(REMOVED_BY_TWIST)]
    bare = [[cell.replace("`", "") for cell in row[:3]] for row in rows]
    return Table.of_texts(heads[:3], bare, words=3)


def _plain(value: object) -> str:
    if isinstance(value, float):
        return f"{value:.12g}"
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.{DIGITS}g}"


def history_short(
    result: TimeHistoryResult,
    verdicts: Sequence[Verdict],
    beside: Sequence[str],
) -> Iterator[Block]:
    """Outcome and verdicts of one history, and how much it says, by texts on those
    `beside` it.
    """
    yield f"Outcome: {timehistory.outcome_text(result)}."
    if result.failure:
        yield Notice(result.failure)
    yield verdicts_in_short(verdicts)
    if verdicts:
        yield limits_table(verdicts)
        yield from map(Notice, doubt_texts(verdicts))
    yield timehistory.restitution_text(result.structure)
    yield from map(Notice, beside)
    told = timehistory.passes_text(result), timehistory.note_of_direction(result)
    yield from filter(None, told)


def ground_section(
    ground: MotionComponents, structure: PodiumStructure, look: Look
) -> ReportSection:
    """The motion of one history, and the periods of the building in its spectra."""
    across = structure.superstructure_y
    drawn = [
        motion_pictures(each, look, (name == "y" and across) or structure.superstructure)
        for name, each in ground.named.items()
    ]
    measured = [
        record_table(each, intensity_measures(each)) for each in horizontal(ground)
    ]
    return ReportSection("Ground motion", [*measured, *drawn])


def horizontal(*grounds: MotionComponents) -> list[GroundMotion]:
    """Their horizontal components."""
    named = (pair for ground in grounds for pair in ground.named.items())
    return [motion for name, motion in named if name != "vertical"]


def response_section(
    result: TimeHistoryResult,
    files: Iterable[tuple[str, object]],
    title: str = "Response",
    figures: Iterable[str] = (),
    plan: Picture | None = None,
) -> ReportSection:
    """The tables of a history, all of its figures or some, and the plan of the columns."""
    wanted = {*figures} or CAPTIONS.keys() - NOT_OF_A_RESPONSE
    drawn = [
        (CAPTIONS[stem], each) for stem, each in pictures(files).items() if stem in wanted
    ]
    shown = [Picture(each, caption) for caption, each in drawn]
    shown += [plan] if plan else []
    tables = timehistory.demand_tables(result, PAGE_UNITS)
    return ReportSection(title, [*tables, *twist_parts(result), *shown])


def plan_picture(result: TimeHistoryResult, label: str, look: Look) -> Picture | None:
    """The plan of the columns with the axial force of each, where it is known."""
    plan = None if result.axial is None else result.axial.plan
    if plan is None or not result.structure.counts_columns:
        return None
    alike = "" if result.both_components else " Columns of one row carry alike."
    caption = (
        f"The columns in plan, symbols not to scale, with their axial forces in kN at the"
        f" {plan.end} at t = {plan.time:.5g} s under {label}, when that of the most loaded"
        f" column (red) is largest.{alike}"
    )
    words = (f"axial forces of the columns at t = {plan.time:.5g} s", label)
    of = ColumnPlan(result.structure, plan)
    return _picture(style.single(draw_plan, of, words, 4.6, 6.0), look, caption)


STEEL_ON_STEEL = {
    True: "Steel on steel by EN 1337-4 has 2.0 f_u on lines",
    False: (
        "Steel on steel in points has 2.3 f_u by N_Rk = 220 R^2 f_u^3/E_d^2 of EN 1337-6"
        " (a formula that was not compared with the text of the code); 2.0 f_u, as on"
        " lines, is on the safe side"
    ),
}
"""What codes say of the strength, of lines and of points (Theory, section 16)."""


def column_sections(
    result: TimeHistoryResult, files: Iterable[tuple[str, object]], label: str
) -> Iterator[ReportSection]:
    """Section on the demands on the most loaded column, with the numbers of its worst
    instants put in, under a record called `label`.
    """
    if result.column_demand is None:
        return
    drawn = pictures(files).get("column")
    left_out = timehistory.left_out_of_columns(result)
    without = f", without {listed(left_out, 'and')}" if left_out else ""
    design = result.structure.column
    on_line = design is not None and design.bears_on_line(result.structure.bearing)
    codes = (
        "f is podium.column.contact_strength. By EN 1992-1-1, formula 6.63, concrete in"
        " a strip at the edge of a column has f_cd, since there is nothing outside it;"
        " under an arc the contact lies inside, and a wider plate has up to 3 f_cd."
        f" {STEEL_ON_STEEL[on_line]}, for rotations up to {STEEL_ROTATION:g} rad."
    )
    yield ReportSection("Forces and pressures of a column", [
        (
            f"Maxima at instants of a dense trace under {label}{without}."
        ),
        *column_table(result),
        *([Picture(drawn, CAPTIONS["column"])] if drawn else []),
        "With numbers, put in in SI units (THEORY.md, section 16):",
        _derived(derived.column_derivations(result)),
        codes,
    ])  # fmt: skip


def case_input(
    case: Case,
    overrides: Sequence[str],
    grounds: Mapping[str, MotionComponents],
) -> Iterator[Block]:
    """Sources of case and motions by their labels, every key of the case, and its file."""
    motions = {}
    for label, ground in grounds.items():
        for component, each in ground.named.items():
            name = f"{component} record".removeprefix("horizontal ")
            # The table of several records has their digests.
            if len(grounds) > 1:
                name = f"{label}, {component}".removesuffix(", horizontal")
            motions[name] = f"{each.source}, scaled by {ground.scale:.9g}"
            if len(grounds) == 1:
                motions[f"SHA-256 of the scaled samples, {name}"] = each.digest
    yield listing([
        ("case", case.source),
        ("SHA-256 of its text", case.digest),
        ("overridden values", ", ".join(overrides)),
        *motions.items(),
    ])  # fmt: skip
    yield "The case as it is written and in SI units, with all defaults:"
    yield input_table(case.document, case.written)
    yield Attachment(f"{case.name}.yaml", yaml_of(case.written or case.document))
