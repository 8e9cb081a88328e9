"""Pages of `rps report` about a case and its histories, and of stored results."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import isnan
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

from rpscli.analyses.result_quantities import plain
from rpscli.case.case import Case, parse_case
from rpscli.case.conditions import Condition
from rpscli.case.text.document import format_of
from rpscli.case.text.files import read_text
from rpscli.case.text.yaml_text import read_yaml
from rpscli.commands import timehistory_run as run
from rpscli.commands.inputs import CaseInput, MotionRequest, case_heading
from rpscli.commands.page_done import PageDone, ends
from rpscli.commands.page_of_records import records_in_short
from rpscli.commands.page_section import (
    PAGE_SECTIONS,
    SectionRequest,
    section_words,
    with_brought,
)
from rpscli.commands.shell.options import CaseRequest, Output
from rpscli.commands.shell.terminal import announce_compilation, concluded
from rpscli.errors import CaseError, RpsError, UsageError
from rpscli.records.source import Source
from rpscli.registry import of_tools
from rpscli.report import case_page as parts
from rpscli.report.figures.history import record_name
from rpscli.report.files import (
    RUN_FILE,
    RUN_KINDS,
    OutputFolder,
    as_text,
    heading,
    read_json,
    results_of,
)
from rpscli.report.page import Block, Notice, ReportSection
from rpscli.report.table import Table

SUMMARY = "summary.json"
STORE = "study.sqlite"
HISTORY = "timehistory"
SWEEP = "sweep"
PAGES = of_tools("pages")
"""Commands of tools that have pages, and what makes them."""
_COMPONENT = {"source": str, "sha256": str}
_MOTION = {
    "scale": float,
    "horizontal": _COMPONENT,
    "vertical": (_COMPONENT,),
    "y": (_COMPONENT,),
}
HISTORY_INPUTS = {
    "overrides": [str], "case": dict, "record": (_MOTION,), "records": ([_MOTION],)
}  # fmt: skip
"""Of one history, or of several."""
Asked: TypeAlias = tuple[Sequence[str], MotionRequest]
"""Sources of records as they were typed, and what else the command line said of them."""


@dataclass(frozen=True)
class Earlier:
    """A folder of earlier results, and what its `run.json` says."""

    folder: Path
    run: Mapping[str, Any]

    def __post_init__(self) -> None:
        """Refuse what would be written elsewhere, or cannot be computed again."""
        if (name := self.run["name"]) != Path(name).name:
            raise ValueError("name must be that of a file, without folders")
        if self.run["command"] == HISTORY and None in self.records:
            raise ValueError("inputs must have a record, or records")

    @property
    def file(self) -> Path | None:
        """The case or the study, as seen from the working folder if it is inside."""
        if self.run["file"] is None:
            return None
        absolute = self.folder.joinpath(self.run["file"]).resolve()
        here = Path.cwd()
        return absolute.relative_to(here) if absolute.is_relative_to(here) else absolute

    @property
    def subject(self) -> CaseRequest:
        """The study or the design as it is on the disk, which has to
        be there, and overrides.
        """
        if self.file is None or not self.file.exists():
            state = (
                "comes from Python, without a file"
                if self.file is None
                else "is not there"
            )
            name = self.run["name"] if self.file is None else self.file
            raise UsageError(f"{self.folder}: {name} {state}; give the file of it")
        return CaseRequest(str(self.file), tuple(self.run["inputs"]["overrides"]))

    @property
    def records(self) -> list[dict[str, Any]]:
        """The motions of one history, or of several."""
        inputs = self.run["inputs"]
        return inputs["records"] or [inputs["record"]]

    def case(self) -> tuple[CaseInput, list[MotionRequest]]:
        """The case and the motions, as they were then."""
        file = self.file
        inputs = self.run["inputs"]
        folder = self.folder if file is None else file.parent
        name = str(file or f"{self.run['name']}.yaml")
        # JSON is YAML too.
        case = parse_case(json.dumps(inputs["case"]), name=name, folder=folder)
        case = replace(case, digest=self.run["sha256"], written={})
        own = case.record
        motions = []
        for given in self.records:
            horizontal, vertical = (
                given[name] and str(given[name]["source"])
                for name in ("horizontal", "vertical")
            )
            if own and own.source == horizontal and (own.y is None or given["y"]):
                horizontal = None
                vertical = None if vertical == own.vertical else vertical
            motions.append(MotionRequest(horizontal, vertical, given["scale"]))
        return CaseInput(case, CaseRequest(name, tuple(inputs["overrides"]))), motions


def earlier_results(folder: Path) -> Earlier:
    """Results that a folder holds."""
    place = folder / RUN_FILE
    what = f"has no {RUN_FILE} of rps"
    try:
        command = read_json(place, RUN_KINDS)["command"]
        if command in {HISTORY, SWEEP, *PAGES}:
            inputs = HISTORY_INPUTS if command == HISTORY else {"overrides": [str]}
            return Earlier(folder, read_json(place, RUN_KINDS | {"inputs": inputs}))
        what = f"holds results of `rps {command}`"
    except FileNotFoundError:
        if (folder / STORE).exists():
            raise UsageError(
                f"{folder}: {STORE} has points of a study that has not ended; `rps sweep"
                f" STUDY -o {folder}` goes on with it"
            ) from None
    except ValueError as error:
        raise CaseError(
            f"{place}: is no description of a run of rps, or is damaged: {error}; run the"
            " command again, or restore the file"
        ) from None
    inside = sorted(path.parent for path in folder.glob(f"*/{RUN_FILE}"))
    hint = f"; name one of the folders in it, such as {inside[0]}" if inside else ""
    raise UsageError(
        f"{folder}: {what}, and a report is made of time histories of one case, of one"
        f" study or of one design{hint}"
    )


def kind_of(source: str) -> str:
    """The command that runs a file: studies and designs have a case at their base."""
    if source == "-":
        return HISTORY
    document = read_yaml(read_text(source), source)
    if (kind := format_of(document)) in PAGES:
        return kind
    return SWEEP if "base" in document.content else HISTORY


class _Histories(NamedTuple):
    """Histories on a page; `worst` is the place of the one
    that turns the columns most.
    """

    title: str
    short: Iterable[Block]
    results: list[ReportSection]
    document: dict[str, Any]
    error: RpsError | None
    worst: int = 0


NO_MOTION = (
    "The case names no ground motion: this page has only the results that need none."
)


def history_page(
    given: CaseInput,
    motions: Sequence[MotionRequest],
    asked: Sequence[Asked],
    conditions: Sequence[Condition],
    earlier: Earlier | None,
    out: Output,
    *,
    extra: Mapping[str, str],
) -> PageDone:
    """Compute what belongs to a case, and put it in order."""
    case = given.case
    histories = list[run.History]()
    if case.record is not None or motions[0].record is not None:
        # A place for the files, which are not written there.
        nowhere = Output(out.terminal, Path(), force=True)
        histories = run.histories_of([given], motions, nowhere)
        announce_compilation(out.terminal)
        made = (_several if len(histories) > 1 else _single)(histories, conditions, out)
    elif extra:
        raise UsageError(
            f"{case.source}: --{next(iter(extra))} needs a ground motion; add --record"
        )
    else:
        made = _without_motion(given)
    out.terminal.warn(made.document["warnings"])
    stored = [*_compared(earlier, histories, made.document)]
    made.results.extend(_extra_sections(given, histories, made, asked, extra, out))

    grounds = {each.label: each.ground for each in histories}
    sections = parts.page_sections(
        case,
        case.title,
        out.look,
        short=made.short,
        warnings=made.document["warnings"],
        inputs=parts.case_input(case, given.request.overrides, grounds),
        results=made.results,
        commands=_commands(given, asked, earlier, extra=extra),
        stored=stored,
        both=any(ground.y is not None for ground in grounds.values()),
    )
    title = f"{made.title}{ends(case)}"
    signed = case.file.document
    return PageDone(case.title, title, sections, made.document, made.error, signed)


def _without_motion(given: CaseInput) -> _Histories:
    """A case that names no motion."""
    warnings = list(given.case.warnings)
    document = {**heading(), "case": case_heading(given), "warnings": warnings}
    return _Histories("Structure", [NO_MOTION], [], concluded(document, None), None)


def _extra_sections(
    given: CaseInput,
    histories: Sequence[run.History],
    made: _Histories,
    asked: Sequence[Asked],
    extra: Mapping[str, str],
    out: Output,
) -> Iterator[ReportSection]:
    """Sections of tools that are asked for, or that records bring."""
    if not histories:
        return
    typed = [record for records, _ in asked for record in records]
    motions = [each.motion for each in histories]
    names = [each.label for each in histories]
    for name, value in with_brought(extra, typed).items():
        wanted = (given, motions, names, made.worst, value, out.terminal, out.look)
        yield PAGE_SECTIONS[name].made(SectionRequest(*wanted))


def _single(
    histories: list[run.History], conditions: Sequence[Condition], out: Output
) -> _Histories:
    """One history, and histories beside it."""
    (history,) = histories
    result = run.compute(history, conditions, out)
    told = run.beside_texts(history, result)
    short = parts.history_short(result, history.verdicts, told)
    files = _names(history.folder)
    ground = parts.ground_section(history.ground, result.structure, out.look)
    plan = parts.plan_picture(result, history.label, out.look)
    response = parts.response_section(result, files, plan=plan)
    columns = parts.column_sections(result, files, history.label)
    results = [ground, response, *columns]
    title = f"Time history under {record_name(result)}"
    return _Histories(title, short, results, history.document, history.error)


def _several(
    histories: list[run.History], conditions: Sequence[Condition], out: Output
) -> _Histories:
    """Histories under several records, with the response to the one
    that turns columns most.
    """
    quiet = replace(out, look=replace(out.look, formats=()))
    found = run.computed_set(histories, conditions, quiet, None, written=False)
    error = run.set_error([found])
    document = run.all_document([found], error)
    # That of a history that failed is none, and counts as 0.
    turned = [each.demands["rotation_ratio"] for each in histories]
    worst = max(range(len(turned)), key=lambda n: 0.0 if isnan(turned[n]) else turned[n])
    result = run.compute(histories[worst], conditions, out, alone=False)
    files = _names(histories[worst].folder)
    components = [
        (f"{history.label}{', y' * (motion is history.ground.y)}", motion)
        for history in histories
        for motion in parts.horizontal(history.ground)
    ]
    names, motions = zip(*components, strict=True)
    label = histories[worst].label
    plan = parts.plan_picture(result, label, out.look)
    all_of = f"{len(histories)} records"
    if len(motions) > len(histories):
        all_of += ", x and y"
    largest = "Response to the record with the largest rotation of the columns, "
    figures = ("orbit", "rotation", "storey_shears", "twist")
    scaled = "as they were scaled"
    results = [
        parts.motions_section(motions, [], all_of, out.look, scaled, names),
        parts.response_section(result, files, f"{largest}{label}", figures, plan),
        *parts.column_sections(result, files, label),
    ]
    title = f"Time histories under {len(histories)} records"
    return _Histories(title, records_in_short(found), results, document, error, worst)


def _names(folder: OutputFolder) -> list[tuple[str, object]]:
    """The files of a folder by name."""
    return [(path.name, content) for path, content in folder.contents.items()]


def typed_together(case: Case, motions: Sequence[MotionRequest]) -> list[Asked]:
    """Motions as they may be typed, those that differ in their record alone together."""
    own = case.record
    alike = dict[MotionRequest, list[str]]()
    plain = (
        own
        and Source.parse(own.source).scheme
        and not (own.y or own.rotation or own.vertical)
    )
    for motion in motions:
        record = motion.record or (
            own.source if own and plain and len(motions) > 1 else None
        )
        key = replace(motion, record=None if record is None else "")
        alike.setdefault(key, []).extend([record] if record else [])
    return [(records, motion) for motion, records in alike.items()]


def _commands(
    given: CaseInput,
    asked: Sequence[Asked],
    earlier: Earlier | None,
    *,
    extra: Mapping[str, str],
) -> list[list[str]]:
    """Commands that make the histories and the page again, which
    may be that of a folder.
    """
    histories = [
        [
            *given.request.words,
            *(word for record in records for word in ("--record", record)),
            *replace(motion, record=None).words,
        ]
        for records, motion in asked
    ]
    subjects = histories if earlier is None else [[str(earlier.folder)]]
    pages = [["rps", "report", *each, *section_words(extra)] for each in subjects]
    without = given.case.record is None and not any(records for records, _ in asked)
    return (
        pages if without else [*(["rps", HISTORY, *each] for each in histories), *pages]
    )


def _compared(
    earlier: Earlier | None, histories: Sequence[run.History], document: Mapping[str, Any]
) -> Iterator[Block]:
    """Differences of case, records and results from the stored ones, if there are any."""
    if earlier is None:
        return
    yield from _changed_inputs(earlier, histories)
    summary = earlier.folder / SUMMARY
    if not summary.exists():
        return
    try:
        before = results_of(read_json(summary, {}))
    except (OSError, ValueError) as error:
        yield Notice(f"{summary} cannot be read, so nothing was compared: {error}")
        return
    if len(histories) > 1:  # the summary of a set is that of its only case
        (document,) = document["sets"]
    yield from _differing_results(earlier.folder, before, results_of(plain(document)))


def _changed_inputs(
    earlier: Earlier, histories: Sequence[run.History]
) -> Iterator[Notice]:
    """Records and a case that are no longer those of the stored results."""
    for history, record in zip(histories, earlier.records, strict=True):
        named = history.ground.named
        if any(
            record[n]["sha256"] != named[n].digest
            for n in ("horizontal", "y")
            if record[n]
        ):
            yield Notice(
                f"The record {history.label} is no longer that of the stored results."
            )
    if (file := earlier.file) is not None:
        digest = hashlib.sha256(file.read_bytes()).hexdigest() if file.is_file() else ""
        if digest != earlier.run["sha256"]:
            state = "has changed since" if digest else "is not there any more"
            yield Notice(f"{file} {state}; this page keeps to the case in run.json.")


def _differing_results(
    folder: Path, before: Mapping[str, Any], now: Mapping[str, Any]
) -> Iterator[Block]:
    """Number of stored results that are those of now, and a table of the others."""
    # By what the record was scaled is a result; the aim that asked for it is computed
    # once.
    names = [name for name in before if name in now and name != "record.scaled_to"]
    differing = [
        (n, as_text(before[n]), as_text(now[n])) for n in names if before[n] != now[n]
    ]
    text = (
        f"The results in {folder} were computed again from what {folder / RUN_FILE} says:"
        f" {len(names) - len(differing)} of {len(names)} stored results are the same to"
        " the last digit."
    )
    if not differing:
        yield text
        return
    yield Notice(
        f"{text} Different: {len(differing)}; this page shows what was computed again."
    )
    yield Table.of_texts(("result", "stored", "computed anew"), differing, words=1)
