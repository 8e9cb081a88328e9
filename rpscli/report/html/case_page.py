"""The page of a case: what it is, and the history that was computed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from typing import NamedTuple

from rpscli.analyses.neighbours import Neighbour
from rpscli.analyses.results import TimeHistoryResult
from rpscli.case.case import Case
from rpscli.records.ground_motion import MotionComponents
from rpscli.records.measures import intensity_measures
from rpscli.report.documents import direction_note
from rpscli.report.figures.look import Look
from rpscli.report.html.page import Block, Notice, Picture, Section, pictures
from rpscli.report.html.sections import (
    input_table,
    motion_pictures,
    motions_section,
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
    neighbours_texts,
    outcome_table,
    outcome_text,
    restitution_text,
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
        building = result.structure.superstructure
        motions = [motion_pictures(each, look, building) for each in self.ground.named.values()]
        measured = record_table(result.record, intensity_measures(result.record))
        response = Section("Response", self.response(*CAPTIONS))
        return [Section("Ground motion", [measured, *motions]), response]

    def response(self, *figures: str) -> list[Block]:
        """Its tables, and some of its figures."""
        drawn, storeys = pictures(self.files), self.result.structure.storeys
        return [
            outcome_table(self.result),
            *([storeys_table(self.result)] if storeys else []),
            *(Picture(files, CAPTIONS[stem]) for stem, files in drawn if stem in figures),
        ]


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
        name = self.worst.result.record.name
        motions = [each.horizontal for each in self.grounds]
        title = f"Response to the record that turns the columns most, {name}"
        return [
            motions_section(motions, [], f"{len(motions)} records", look, "as they were scaled"),
            Section(title, self.worst.response("rotation", "storey_shears")),
        ]


def case_sections(
    case: Case,
    overrides: Sequence[str],
    commands: Sequence[Sequence[str]],
    look: Look,
    warnings: Sequence[str],
    history: History | Several | None = None,
    stored: Sequence[Block] = (),
) -> list[Section]:
    """Everything about a case, and its histories if there are any; `stored`: what was before."""
    short: Iterable[Block] = [
        "The case names no ground motion: this page ends with what follows without one."
    ]
    results, grounds = list[Section](), list[MotionComponents]()
    if history is not None:
        short, results, grounds = history.short(), history.sections(look), [*history.grounds]
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
