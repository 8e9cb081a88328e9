"""Sections of pages: what a case is, its ground motions, and the history that was computed."""

from __future__ import annotations

import json
import math
import shlex
from collections.abc import Iterable, Iterator, Mapping, Sequence
from importlib import resources
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from rpscli.analyses.neighbours import Neighbour
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.trace import Event
from rpscli.case.case import Case
from rpscli.case.schema.keys import unit
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import Superstructure
from rpscli.records.ground_motion import GroundMotion, MotionComponents
from rpscli.records.measures import intensity_measures
from rpscli.records.spectrum import DAMPING, drawn_spectrum
from rpscli.report.bundles import bearing_files
from rpscli.report.documents import direction_note, versions
from rpscli.report.figures import style
from rpscli.report.figures.look import Draw, Look, figure_files
from rpscli.report.figures.motions import record_figure, spectra_figure
from rpscli.report.figures.planes import record_name
from rpscli.report.figures.structure import structure_figure
from rpscli.report.html.page import Block, Code, Notice, Picture, Section, page_look, pictures
from rpscli.report.leaves import leaves
from rpscli.report.study.statistics import verdicts_in_short
from rpscli.report.table import Column, Table, shown
from rpscli.report.tables.derivation import derivations, first_shape
from rpscli.report.tables.motions import record_table
from rpscli.report.tables.timehistory import (
    limits_table,
    neighbours_texts,
    outcome_table,
    outcome_text,
    restitution_text,
    storeys_table,
)
from rpscli.sweep.statistics.verdicts import Verdict

MOST_ROWS = 100
MOST_SPECTRA = 200


def motion_pictures(
    motion: GroundMotion, look: Look, building: Superstructure | None = None
) -> Picture:
    """Acceleration, velocity, displacement and response spectrum of a motion, with T1."""
    period = None if building is None else float(building.periods[0])
    return _picture(
        lambda: record_figure(motion, drawn_spectrum(motion), period),
        look,
        f"{motion.name}: acceleration, velocity and displacement of the ground, and the response"
        f" spectrum at {style.percent(DAMPING)} of critical damping.",
    )


def _picture(draw: Draw, look: Look, caption: str) -> Picture:
    ((_, files),) = pictures(figure_files({"figure": draw}, page_look(look)).items())
    return Picture(files, caption)


def motions_section(
    motions: Sequence[GroundMotion],
    unreadable: Sequence[str],
    title: str,
    look: Look,
    which: str = "before they are scaled",
) -> Section:
    """Records of a study, or of several histories: peaks, digests and spectra."""
    blocks: list[Block] = [*unreadable]
    if motions:
        blocks.append(_table(motions[:MOST_ROWS]))
        shown = motions[:MOST_SPECTRA]
        blocks.append(
            _picture(
                lambda: spectra_figure([drawn_spectrum(each) for each in shown], title),
                look,
                f"Response spectra of {len(shown)} records {which}, at"
                f" {style.percent(DAMPING)} of critical damping, with their median.",
            )
        )
    if len(motions) > MOST_ROWS:
        blocks.append(f"The table shows the first {MOST_ROWS} of {len(motions)} records.")
    return Section("Ground motions", blocks)


def _table(motions: Sequence[GroundMotion]) -> Table:
    rows = [
        (each.source, each.digest[:16], *map("{:.4g}".format, numbers))
        for each in motions
        for of in [intensity_measures(each)]
        for numbers in [(each.duration, of.pga, of.pgv, of.d5_95)]
    ]
    heads = (
        "record", "SHA-256 begins with", "duration [s]", "PGA [m/s2]", "PGV [m/s]", "5-95 % [s]"
    )  # fmt: skip
    return Table.of_texts(heads, rows, words=2)


CAPTIONS = {
    "s": "The structure at rest.",
    "bearing": "A column at rest, where rolling ends and at the critical rotation, to one scale;"
    " one of its ends enlarged; and the horizontal force at the cap beam that holds it there."
    " R runs from the middle of the column to the edge of the flat part of its end; dots are"
    " contacts.",
    "orbit": "From above: the path of the cap beam over the ground, and the moment of ground and"
    " building about the contacts, beyond whose circle upright columns uplift; time in colour.",
    "rotation": "Ground acceleration, rotation of the columns with the phases of the motion, and"
    " the events.",
    "displacements": "Displacements relative to the ground against time.",
    "moment_rotation": "Driving and restoring moment about the contact points against rotation.",
    "energy": "Balance of the energy supplied by the ground.",
    "storey_shears": "Largest storey shears on the bearings and on a fixed base.",
    "devices": "Force against displacement of each device between ground and cap beam.",
}

DIGITS = 6
THEORY = "THEORY.md"
HIDDEN = "| assumed |"
"""Begins the table of the theory that says what the model cannot tell."""


def page_sections(
    case: Case,
    title: str,
    look: Look,
    short: Iterable[Block],
    inputs: Iterable[Block],
    results: Iterable[Section],
    repeat: Iterable[Block],
    which: Sequence[Block] = (),
) -> list[Section]:
    """All of a page in its order; `which` says of which system structure and formulas are."""
    structure, podium = case.structure, case.document["podium"]
    return [
        Section("In short", [*short]),
        Section("The structure", [*which, *structure_blocks(structure, title, look)]),
        Section("Input", [*inputs]),
        Section("Derived quantities", [*which, *derived_blocks(structure, podium)]),
        *results,
        Section("Limits of the model", [hidden_table()]),
        Section("How to repeat it", [*repeat]),
    ]


def notices(texts: Iterable[str]) -> Iterator[Block]:
    """What must be read before the numbers are used."""
    return (Notice(f"Warning: {text}") for text in texts)


def programs() -> str:
    """What made the numbers, with versions."""
    return ", ".join(f"{name} {version}" for name, version in versions().items() if version)


def repeated(*commands: Sequence[str]) -> Iterator[Block]:
    """Commands that make the same again."""
    yield "From the folder in which this page was made, with the same versions:"
    yield Code("\n".join(map(shlex.join, commands)))


def structure_blocks(structure: PodiumStructure, title: str, look: Look) -> list[Block]:
    """The drawings, and the storeys."""
    made = figure_files({"s": lambda: structure_figure(structure, title)}, page_look(look))
    files = [*made.items(), *bearing_files(structure, title, page_look(look))]
    blocks: list[Block] = [Picture(each, CAPTIONS[stem]) for stem, each in pictures(files)]
    if structure.superstructure is not None:
        blocks += ["Storeys, the roof on top:", _storeys(structure)]
    return blocks


def _storeys(structure: PodiumStructure) -> Table:
    building = structure.superstructure
    assert building is not None, "there are storeys"
    shape, heights = first_shape(building), building.storey_heights
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
    return Table([Column(name, "-", each[::-1], name, _number) for name, each in columns.items()])


def input_table(content: Mapping[str, Any], written: Mapping[str, Any] | None = None) -> Table:
    """Every key of a case in SI units, defaults written out, beside what the user wrote."""
    rows = [(key, _plain(value), unit(key).removeprefix("-")) for key, value in leaves(content)]
    if not written:
        return Table.of_texts(("key", "value", "unit"), rows, words=3)
    own = {key: _as_typed(value) for key, value in leaves(written)}
    beside = [(key, own.get(key, ""), *rest) for key, *rest in rows]
    return Table.of_texts(("key", "as written", "value in SI", "unit"), beside, words=4)


def _as_typed(value: object) -> str:
    """A value of the file, lists of texts without their quotes."""
    if isinstance(value, list):
        return f"[{', '.join(map(_as_typed, value))}]"
    return _plain(value)


def derived_blocks(structure: PodiumStructure, podium: Mapping[str, Any]) -> list[Block]:
    """Derived quantities with formulas, and with the numbers put in."""
    rows = [
        (
            row.label,
            row.symbol,
            row.formula or "from the case",
            row.numbers,
            _number(row.value),
            "" if row.unit == "-" else row.unit,
        )
        for row in derivations(structure, podium)
    ]
    text = (
        "Angles are in radians, everything else in SI units. The numbers put in are rounded to"
        f" {DIGITS} digits; the values follow from unrounded ones. The formulas are derived in"
        f" {THEORY}, sections 1 to 7. f, κ and e_given are factor, loss and restitution of"
        " podium.impact, I is podium.bearing.inertia_ratio."
    )
    heads = ("quantity", "symbol", "formula", "with numbers", "value", "unit")
    return [text, Table.of_texts(heads, rows, words=4)]


def hidden_table() -> Table:
    """Limits of the model, in the words of the theory."""
    text = resources.files("rpscli").joinpath(THEORY).read_text(encoding="utf-8")
    lines = text[text.index(HIDDEN) :].split("\n\n", 1)[0].splitlines()
    head, _, *rows = ([cell.strip() for cell in line.strip("|").split("|")] for line in lines)
    bare = [[cell.replace("`", "") for cell in row[:3]] for row in rows]
    return Table.of_texts(head[:3], bare, words=3)


def _plain(value: object) -> str:
    if isinstance(value, float):
        return f"{value:.12g}"
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.{DIGITS}g}"


class History(NamedTuple):
    """What came of a case under a motion, the files of it by name, and histories beside it."""

    ground: MotionComponents
    result: TimeHistoryResult
    verdicts: Sequence[Verdict]
    files: Iterable[tuple[str, object]]
    beside: Sequence[Neighbour] = ()

    @property
    def grounds(self) -> list[MotionComponents]:
        """Its motion."""
        return [self.ground]

    def short(self) -> Iterator[Block]:
        """Outcome and verdicts, and how much a single history says."""
        yield f"Outcome: {outcome_text(self.result)}."
        if self.result.failure:
            yield Notice(self.result.failure)
        if self.verdicts:
            yield verdicts_in_short(self.verdicts, f"{len(self.verdicts)} limits")
            yield limits_table(self.verdicts)
        else:
            yield "No limits were set."
        yield restitution_text(self.result.structure)
        yield from map(Notice, neighbours_texts(self.result, self.beside))
        yield from filter(None, [direction_note([self.ground.y is not None])])

    def sections(self, look: Look) -> list[Section]:
        """Motion and response."""
        result = self.result
        structure = result.structure
        building, across = structure.superstructure, structure.superstructure_y
        motions = [
            motion_pictures(each, look, (name == "y" and across) or building)
            for name, each in self.ground.named.items()
        ]
        measured = [
            record_table(each, intensity_measures(each)) for each in horizontal(self.ground)
        ]
        response = Section("Response", self.response(*CAPTIONS))
        return [Section("Ground motion", [*measured, *motions]), response]

    def response(self, *figures: str) -> list[Block]:
        """Its tables, and some of its figures."""
        drawn, storeys = pictures(self.files), self.result.structure.storeys
        return [
            outcome_table(self.result),
            *([storeys_table(self.result)] if storeys else []),
            *(Picture(files, CAPTIONS[stem]) for stem, files in drawn if stem in figures),
            *passes_blocks(self.result.events, self.result.structure.bearing.alpha),
        ]


def horizontal(ground: MotionComponents) -> list[GroundMotion]:
    """Its horizontal components."""
    return [motion for name, motion in ground.named.items() if name != "vertical"]


def passes_blocks(events: Sequence[Event], alpha: float) -> Iterator[Block]:
    """When a pair brought the columns nearest upright, how near, and what that took."""
    passes = [event for event in events if event.kind == "pass"]
    if not passes:
        return
    rows = []
    for number, each in enumerate(passes[:MOST_ROWS], 1):
        azimuth, least = math.degrees(each.azimuth or 0.0), (each.least_tilt or 0.0) / alpha
        numbers = each.time, azimuth, least, each.nearness, each.loss_share, each.energy_lost
        rows.append((str(number), *map(shown, numbers)))
    cut = f" The first {MOST_ROWS} of {len(passes)}; events.csv has all." * (
        len(passes) > MOST_ROWS
    )
    yield (
        "Passes: where columns came nearest to upright, and the azimuth after it, from x towards y."
        " s is the time they take there over that of a contact, l how much of what an impact would"
        f" lose is lost.{cut}"
    )
    heads = ("pass", "time [s]", "azimuth [deg]", "θ_min/α", "s", "l", "lost [J]")
    yield Table.of_texts(heads, rows)


class Several(NamedTuple):
    """What came of a case under several motions: their tables, and the history that turns most."""

    grounds: Sequence[MotionComponents]
    verdicts: Sequence[Verdict]
    parts: Sequence[Block]
    worst: History

    def short(self) -> Iterator[Block]:
        """Each record, mean and largest, and verdicts."""
        if self.verdicts:
            yield verdicts_in_short(self.verdicts, f"{len(self.verdicts)} limits")
        else:
            yield "No limits were set."
        yield from self.parts

    def sections(self, look: Look) -> list[Section]:
        """Motions, and the response to the one that turns the columns most."""
        name = record_name(self.worst.result)
        motions = [motion for each in self.grounds for motion in horizontal(each)]
        title = f"Response to the record with the largest rotation of the columns, {name}"
        return [
            motions_section(motions, [], f"{len(motions)} records", look, "as they were scaled"),
            Section(title, self.worst.response("orbit", "rotation", "storey_shears")),
        ]


def case_sections(
    case: Case,
    overrides: Sequence[str],
    commands: Sequence[Sequence[str]],
    look: Look,
    warnings: Sequence[str],
    history: History | Several | None = None,
    stored: Sequence[Block] = (),
    more: Sequence[Section] = (),
) -> list[Section]:
    """Everything about a case, and its histories if there are any; `stored`: what was before."""
    short: Iterable[Block] = [
        "The case names no ground motion: this page has only the results that need none."
    ]
    results, grounds = list[Section](), list[MotionComponents]()
    if history is not None:
        short, grounds = history.short(), [*history.grounds]
        results = [*history.sections(look), *more]
    inputs, repeat = _input(case, overrides, grounds), [*repeated(*commands), *stored]
    short = chain(short, notices(warnings))
    return page_sections(case, case.title, look, short, inputs, results, repeat)


def _input(
    case: Case, overrides: Sequence[str], grounds: Sequence[MotionComponents]
) -> Iterator[Block]:
    motions = {}
    for number, ground in enumerate(grounds, 1):
        for component, each in ground.named.items():
            name = f"{component} record".removeprefix("horizontal ")
            # The table of several records has their digests.
            name += f" {number}" * (len(grounds) > 1)
            motions[name] = f"{each.source}, scaled by {ground.scale:.9g}"
            if len(grounds) == 1:
                motions[f"SHA-256 of the scaled samples, {name}"] = each.digest
    yield Table.listing(
        [
            ("case", case.source),
            ("SHA-256 of its text", case.digest),
            ("overridden values", ", ".join(overrides)),
            *motions.items(),
            ("made by", programs()),
        ]
    )
    yield "The case as it is written and in SI units, with all defaults:"
    yield input_table(case.document, case.written)
