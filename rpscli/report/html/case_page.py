"""The page of a case: what it is, and the history that was computed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from typing import NamedTuple

from rpscli.analyses.results import TimeHistoryResult
from rpscli.case.case import Case
from rpscli.records.ground_motion import MotionComponents
from rpscli.records.measures import intensity_measures
from rpscli.report.figures.look import Look
from rpscli.report.html.page import Block, Notice, Picture, Section, pictures
from rpscli.report.html.sections import (
    input_table,
    motion_pictures,
    notices,
    page_sections,
    programs,
    repeated,
)
from rpscli.report.study.statistics import verdicts_in_short
from rpscli.report.table import Table
from rpscli.report.tables.motions import record_table
from rpscli.report.tables.timehistory import (
    limits_table,
    outcome_table,
    outcome_text,
    storeys_table,
)
from rpscli.sweep.statistics.verdicts import Verdict

CAPTIONS = {
    "rotation": "Ground acceleration, rotation of the columns with the phases of the motion, and"
    " the events.",
    "displacements": "Displacements to the ground against time.",
    "moment_rotation": "Moment about the contact points against rotation, and what the weight alone"
    " does.",
    "energy": "Where the energy of the ground has gone.",
    "storey_shears": "Largest storey shears on the bearings and on a fixed base.",
    "devices": "Force against displacement of each device between ground and cap beam.",
}


class History(NamedTuple):
    """What came of a case under a motion, and the files of it by name."""

    ground: MotionComponents
    result: TimeHistoryResult
    verdicts: Sequence[Verdict]
    files: Iterable[tuple[str, object]]


def case_sections(
    case: Case,
    overrides: Sequence[str],
    commands: Sequence[Sequence[str]],
    look: Look,
    warnings: Sequence[str],
    history: History | None = None,
    stored: Sequence[Block] = (),
) -> list[Section]:
    """Everything about a case, and its history if there is one; `stored` says what was before."""
    short, results, ground = _outcome(history), list[Section](), None
    if history is not None:
        result, ground = history.result, history.ground
        tables = [outcome_table(result)]
        tables += [storeys_table(result)] * bool(result.structure.storeys)
        drawn = [Picture(files, CAPTIONS[stem]) for stem, files in pictures(history.files)]
        building = result.structure.superstructure
        motions = [motion_pictures(each, look, building) for each in ground.named.values()]
        measured = record_table(result.record, intensity_measures(result.record))
        results.append(Section("Ground motion", [measured, *motions]))
        results.append(Section("Response", [*tables, *drawn]))
    inputs, repeat = _input(case, overrides, ground), [*repeated(*commands), *stored]
    short = chain(short, notices(warnings))
    return page_sections(case, case.title, look, short, inputs, results, repeat)


def _outcome(history: History | None) -> Iterator[Block]:
    if history is None:
        yield "The case names no ground motion: this page ends with what follows without one."
        return
    yield f"Outcome: {outcome_text(history.result)}."
    if history.result.failure:
        yield Notice(history.result.failure)
    if history.verdicts:
        yield verdicts_in_short(history.verdicts, f"{len(history.verdicts)} limits")
        yield limits_table(history.verdicts)
    else:
        yield "No limits were set."


def _input(
    case: Case, overrides: Sequence[str], ground: MotionComponents | None
) -> Iterator[Block]:
    motions = {}
    if ground is not None:
        for component, each in ground.named.items():
            name = f"{component} record".removeprefix("horizontal ")
            motions[name] = f"{each.source}, scaled by {ground.scale:.9g}"
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
    yield "The case in SI units, with all defaults:"
    yield input_table(case.document)
