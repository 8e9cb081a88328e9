"""The section of `rps report CASE --target SPECTRUM`: the records beside their target."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rpscli.commands.page_section import PageSection, SectionRequest
from rpscli.errors import RecordError, UsageError
from rpscli.records.source import LIST, Source
from rpscli.report.files import RUN_FILE, RUN_KINDS, read_json

if TYPE_CHECKING:
    from rpscli.commands.inputs import CaseMotion
    from rpscli.records.ground_motion import GroundMotion
    from rpscli.records.measures import Of
    from rpscli.records.target import TargetSpectrum
    from rpscli.report.page import Block, ReportSection
    from rpscli.tools.selection.request import SelectionRequest
    from rpscli.tools.selection.requirements import Periods
    from rpscli.tools.selection.selection import Selection

SELECT = "record select"
OF_SELECTION = {
    "target": str,
    "request": {"count": float, "periods": [float], "of": str, "rules": (str,)},
}
"""Inputs in `run.json` beside a list that `rps record select` made."""
TITLE = "Target spectrum"


def target_section(asked: SectionRequest) -> ReportSection:
    """Spectra of the records under their factors, events, and rules that they meet."""
    from rpscli.report.page import Notice, ReportSection
    from rpscli.tools.selection.command import periods_of
    from rpscli.tools.selection.selection import as_it_is

    case = asked.given.case
    structure, limit = periods_of(case, case.source)
    target, request, why = _request(asked, structure, limit)
    try:
        of_set = dict(_motions(asked, request.of))
        selection = as_it_is(of_set.values(), target, request)
    except RecordError as error:
        return ReportSection(TITLE, [Notice(f"The records cannot be compared: {error}")])
    return ReportSection(TITLE, _blocks(asked, selection, [*of_set], structure, why))


def _request(
    asked: SectionRequest, structure: Periods, limit: str
) -> tuple[TargetSpectrum, SelectionRequest, str]:
    """The target, what its code asks of a set for this case, and why its periods are
    these.
    """
    from rpscli.records.target import load_target
    from rpscli.tools.selection.command import range_of_periods, usual_component
    from rpscli.tools.selection.request import SelectionRequest
    from rpscli.tools.selection.requirements import RULES

    count = len(asked.motions)
    if asked.value.startswith(f"{LIST}:"):
        text, of_list = _of_list(Path(Source.parse(asked.value).place))
        low, high = of_list["periods"]
        own = {"of": of_list["of"], "rules": of_list["rules"], "structure": structure}
        why = "as the list was selected for"
        return load_target(text), SelectionRequest(count, (low, high), **own), why
    target = load_target(asked.value)
    rules = RULES.get(target.rules)
    span, why = range_of_periods(structure, limit, target, rules)
    both = any(motion.ground.y is not None for motion in asked.motions)
    of = target.of or (rules and rules.of) or usual_component(both=both)
    return target, SelectionRequest(count, span, of=of, structure=structure), why


def _of_list(file: Path) -> tuple[str, dict[str, Any]]:
    """The target and the request for which a list was selected."""
    place = file.parent / RUN_FILE
    try:
        run = read_json(place, RUN_KINDS | {"inputs": {}})
        if run["command"] == SELECT:
            run = read_json(place, RUN_KINDS | {"inputs": OF_SELECTION})
    except (OSError, ValueError) as error:
        raise UsageError(
            f"--target {LIST}:{file}: {place} does not say what the list was selected for:"
            f" {error}; give the spectrum itself"
        ) from None
    if run["command"] != SELECT or len(run["inputs"]["request"]["periods"]) != 2:
        raise UsageError(
            f"--target {LIST}:{file}: was not made by `rps {SELECT}`; give the spectrum"
            " itself"
        )
    text = run["inputs"]["target"]
    if run["file"] is not None:
        _, mark, options = text.partition("?")
        text = f"{file.parent / run['file']}{mark}{options}"
    return text, run["inputs"]["request"]


def brought(records: Sequence[str]) -> str:
    """The only list among records that `rps record select` made; empty without one."""
    if len(records) != 1 or (of := Source.parse(records[0])).scheme != LIST:
        return ""
    try:
        run = read_json(Path(of.place).parent / RUN_FILE, RUN_KINDS)
    except (OSError, ValueError):
        return ""
    names = {Path(name).name for name in run["files"]}
    made = run["command"] == SELECT and Path(of.place).name in names
    return records[0] if made else ""


Motions = tuple[tuple["GroundMotion", ...], float]
"""A motion, or both of a pair, without the factor that follows."""


def _motions(asked: SectionRequest, of: Of | str) -> Iterator[tuple[str, Motions]]:
    """By name single components, or pairs where the code compares these, each once."""
    found: dict[str, float] = {}
    for label, motion in zip(asked.labels, asked.motions, strict=True):
        for name, (motions, factor) in _of_history(label, motion, of):
            one = Source.parse(motions[0].source).without("factor")
            key = name if len(motions) == 1 else str(one)
            again = key in found
            if found.setdefault(key, factor) != factor:
                raise RecordError(
                    f"{key}: components of one recording have different factors; scale"
                    " both alike"
                )
            if not again:
                yield name, (motions, factor)


def _of_history(
    label: str, motion: CaseMotion, of: Of | str
) -> Iterator[tuple[str, Motions]]:
    """Motions of one history before they are scaled, with their factor."""
    from rpscli.tools.selection.candidates import motions_or_pairs

    found: list[tuple[GroundMotion, ...]]
    ground = motion.ground
    components = [ground.horizontal.scaled(1.0 / ground.scale)]
    if ground.y is not None:
        components.append(ground.y.scaled(1.0 / ground.scale))
    own = {Source.parse(each.source).factor for each in components}
    factor = own.pop() if len(own) == 1 else 1.0
    if of == "component":
        found = [(each,) for each in components]
    elif ground.y is not None:
        found = [tuple(components)]
    else:
        found = motions_or_pairs(components, of)  # type: ignore[arg-type]
    for name, motions in zip((label, f"{label}, y"), found, strict=False):
        unscaled = tuple(each.scaled(1.0 / factor) for each in motions)
        yield name, (unscaled, factor * ground.scale)


def _blocks(
    asked: SectionRequest,
    selection: Selection,
    names: Sequence[str],
    structure: Periods,
    why: str,
) -> list[Block]:
    """Rules first, then the motions, the fit and the figure."""
    from rpscli.records.target import COMPONENTS
    from rpscli.report.figures.style import figure_files
    from rpscli.report.page import Notice, Picture, page_look
    from rpscli.report.table import Column, Table, picked
    from rpscli.tools.selection import report
    from rpscli.tools.selection.figure import selection_figure

    shown = ("event", "factor", "pgv", "pgd", "misfit")
    columns = picked(report.selection_columns(selection), *shown)
    draw = partial(selection_figure, selection, selection.target.name)
    drawn = figure_files({"target": draw}, page_look(asked.look))
    caption = (
        "Response spectra of the records under their factors, of"
        f" {COMPONENTS[selection.of]}, with their mean and the target; peaks of the ground."
    )
    return [
        *report.rules_tables(selection),
        Table([Column("record", "-", names, "record", str), *columns], words=2),
        Table.listing(report.fit_rows(selection, why).items()),
        *map(Notice, report.selection_doubts(selection, structure.fixed)),
        Picture({each.ending: each for each in drawn.values()}, caption),
    ]


SECTION = PageSection(
    (
        "Compare the records of a CASE with a spectrum, as in `rps record select`: a code,"
        " a CSV file, or list:FILE.txt for that of a list, which --record list:FILE.txt"
        " brings."
    ),
    target_section,
    metavar="SPECTRUM",
    brought=brought,
)
"""Target spectrum, events and rules met."""
