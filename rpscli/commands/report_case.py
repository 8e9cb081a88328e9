"""The page of a case, of its time history if it has a record, and of stored results of one."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import isnan
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from rpscli.analyses.result_quantities import plain
from rpscli.commands.inputs import CaseInput, MotionRequest, case_heading
from rpscli.commands.shell.options import CaseRequest, OutputRequest
from rpscli.commands.shell.terminal import Terminal, concluded
from rpscli.commands.shell.waiting import announce_compilation
from rpscli.errors import UsageError
from rpscli.records.source import Source
from rpscli.report.documents import as_text, heading, read_json, results_of
from rpscli.report.figures.look import Look
from rpscli.report.files import RUN_FILE, RUN_KINDS
from rpscli.report.html.page import Block, Notice, Section, page_look
from rpscli.report.table import Table

if TYPE_CHECKING:
    from rpscli.case.case import Case
    from rpscli.case.conditions import Condition
    from rpscli.case.schema.case_file import DocumentSection
    from rpscli.commands.timehistory_run import HistoryRequest
    from rpscli.errors import RpsError

SUMMARY, STORE = "summary.json", "study.sqlite"
HISTORY, SWEEP, DESIGN = "timehistory", "sweep", "design"
_COMPONENT = {"source": str, "sha256": str}
_MOTION = {"scale": float, "horizontal": _COMPONENT, "vertical": (_COMPONENT,), "y": (_COMPONENT,)}
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
        absolute, here = self.folder.joinpath(self.run["file"]).resolve(), Path.cwd()
        return absolute.relative_to(here) if absolute.is_relative_to(here) else absolute

    @property
    def subject(self) -> CaseRequest:
        """The study or the design as it is on the disk, which has to be there, and overrides."""
        if self.file is None or not self.file.exists():
            raise UsageError(f"{self.folder}: its file {self.file or ''} is not there; give it")
        return CaseRequest(str(self.file), tuple(self.run["inputs"]["overrides"]))

    @property
    def records(self) -> list[dict[str, Any]]:
        """The motions of one history, or of several."""
        inputs = self.run["inputs"]
        return inputs["records"] or [inputs["record"]]


def earlier_results(folder: Path) -> Earlier:
    """Results that a folder holds."""
    place, what = folder / RUN_FILE, f"has no {RUN_FILE} of rps"
    try:
        command = read_json(place, RUN_KINDS)["command"]
        if command in {HISTORY, SWEEP, DESIGN}:
            inputs = HISTORY_INPUTS if command == HISTORY else {"overrides": [str]}
            return Earlier(folder, read_json(place, RUN_KINDS | {"inputs": inputs}))
        what = f"holds results of `rps {command}`"
    except FileNotFoundError:
        if (folder / STORE).exists():
            raise UsageError(
                f"{folder}: {STORE} has points of a study that has not ended; `rps sweep STUDY -o"
                f" {folder}` goes on with it"
            ) from None
    except ValueError as error:
        what = f"holds a {RUN_FILE} of which {error}"
    inside = sorted(path.parent for path in folder.glob(f"*/{RUN_FILE}"))
    hint = f"; name one of the folders in it, such as {inside[0]}" if inside else ""
    raise UsageError(
        f"{folder}: {what}, and a report is made of time histories of one case, of one study or of"
        f" one design{hint}"
    )


def kind_of(source: str) -> str:
    """The command that runs a file: studies and designs have a case at their base."""
    if source == "-":
        return HISTORY
    from rpscli.case.text.document import is_design
    from rpscli.case.text.files import read_text
    from rpscli.case.text.yaml_text import read_yaml

    document = read_yaml(read_text(source), source)
    if is_design(document):
        return DESIGN
    return SWEEP if "base" in document.content else HISTORY


def earlier_case(earlier: Earlier) -> tuple[CaseInput, list[MotionRequest]]:
    """The case and the motions of earlier results, as they were then."""
    from rpscli.case.case import parse_case

    run, file = earlier.run, earlier.file
    folder = earlier.folder if file is None else file.parent
    name = str(file or f"{run['name']}.yaml")
    # JSON is YAML too.
    case = parse_case(json.dumps(run["inputs"]["case"]), name=name, folder=folder)
    case, own, motions = replace(case, digest=run["sha256"], written={}), case.record, []
    for given in earlier.records:
        sources = (
            given[name] and str(given[name]["source"]) for name in ("horizontal", "vertical")
        )
        horizontal, vertical = sources
        if own and own.source == horizontal and (own.y is None or given["y"]):
            horizontal, vertical = None, None if vertical == own.vertical else vertical
        motions.append(MotionRequest(horizontal, vertical, given["scale"]))
    return CaseInput(case, CaseRequest(name, tuple(run["inputs"]["overrides"]))), motions


def typed_together(case: Case, motions: Sequence[MotionRequest]) -> list[Asked]:
    """Motions as they may be typed, those that differ in their record alone together."""
    own, alike = case.record, dict[MotionRequest, list[str]]()
    plain = own and Source.parse(own.source).scheme and not (own.y or own.rotation or own.vertical)
    for motion in motions:
        record = motion.record or (own.source if own and plain and len(motions) > 1 else None)
        key = replace(motion, record=None if record is None else "")
        alike.setdefault(key, []).extend([record] if record else [])
    return [(records, motion) for motion, records in alike.items()]


@dataclass(frozen=True)
class PageDone:
    """A page's title and sections, what was found for JSON, its error, and who answers for it."""

    title: str
    subtitle: str
    sections: Sequence[Section]
    document: dict[str, Any]
    error: RpsError | None
    signed: DocumentSection


def ends(case: Case) -> str:
    """The kind of compliant ends, to follow in a heading."""
    kind = case.structure.contact.kind
    return "" if kind == "rigid" else f", {kind} contact"


def case_page(
    given: CaseInput,
    motions: Sequence[MotionRequest],
    asked: Sequence[Asked],
    conditions: Sequence[Condition],
    look: Look,
    earlier: Earlier | None,
    terminal: Terminal,
    *,
    with_budget: bool = False,
) -> PageDone:
    """Compute what belongs to a case, and put it in order."""
    from rpscli.commands import timehistory_run as run
    from rpscli.commands.budget import case_budget
    from rpscli.report.figures.history import record_name
    from rpscli.report.html import case_page as parts
    from rpscli.report.limits import verdicts_in_short

    case, title = given.case, f"Structure{ends(given.case)}"
    document = {**heading(), "case": case_heading(given), "warnings": list(case.warnings)}
    document, error = concluded(document, None), None
    short: Iterable[Block] = [
        "The case names no ground motion: this page has only the results that need none."
    ]
    results, stored, requests = list[Section](), list[Block](), list["HistoryRequest"]()
    if case.record is not None or motions[0].record is not None:
        # A place for the files, which are not written there.
        requests = run.history_requests([given], motions, OutputRequest(Path(), force=True))
        announce_compilation(terminal)
        first = 0
        if len(requests) > 1:
            quiet = replace(look, formats=())
            found = run.computed_set(requests, conditions, quiet, terminal, None, written=False)
            error = run.set_error([found])
            document, now = run.all_document([found], error), run.set_document(found)
            # That of a history that failed is none, and counts as 0.
            turned = [each.demands["rotation_ratio"] for each in found.histories]
            first = max(range(len(turned)), key=lambda n: 0.0 if isnan(turned[n]) else turned[n])
        worst = requests[first]
        done, result = run.compute(worst, conditions, page_look(look), terminal)
        files = [(path.name, content) for path, content in worst.folder.contents.items()]
        title = f"Time history under {record_name(result)}{ends(case)}"
        if len(requests) > 1:
            short = [verdicts_in_short(found.verdicts), *[*run.set_tables([found])][1:]]
            motions_of = parts.horizontal(*(request.ground for request in requests))
            largest = "Response to the record with the largest rotation of the columns, "
            figures = ("orbit", "rotation", "storey_shears")
            results = [
                parts.motions_section(
                    motions_of, [], f"{len(motions_of)} records", look, "as they were scaled"
                ),
                parts.response_section(result, files, f"{largest}{record_name(result)}", figures),
            ]
            title = f"Time histories under {len(requests)} records{ends(case)}"
        else:
            short = parts.history_short(result, done.verdicts, run.look_beside(done, result))
            document, error, now = done.document, done.error, done.document
            ground = parts.ground_section(worst.ground, result.structure, look)
            results = [ground, parts.response_section(result, files)]
        results += parts.column_sections(result, files)
        terminal.warn(document["warnings"])
        stored = [] if earlier is None else [*_stored(earlier, requests, now)]
        if with_budget:
            order = sorted(range(len(motions)), key=lambda n: n != first)
            grounds = [requests[n].ground for n in order]
            budget = case_budget(given, [motions[n] for n in order], grounds, terminal)
            results.append(budget.section(look, worst.label))
    elif with_budget:
        raise UsageError(f"{case.source}: --budget needs a ground motion; add --record")
    folder = None if earlier is None else earlier.folder
    sections = parts.page_sections(
        case,
        case.title,
        look,
        short=short,
        warnings=document["warnings"],
        inputs=parts.case_input(case, given.request.overrides, [each.ground for each in requests]),
        results=results,
        commands=_commands(given, asked, folder, with_budget=with_budget),
        stored=stored,
        both=any(request.ground.y is not None for request in requests),
    )
    return PageDone(case.title, title, sections, document, error, case.file.document)


def subject_words(source: str, overrides: Iterable[str]) -> list[str]:
    """A case or a study on a command line, with what is put over it."""
    return [source, *(word for override in overrides for word in ("--set", override))]


def _commands(
    given: CaseInput, asked: Sequence[Asked], folder: Path | None, *, with_budget: bool
) -> list[list[str]]:
    """Commands that make the histories and the page again, which may be that of a folder."""
    words = subject_words(given.request.source, given.request.overrides)
    histories = []
    for records, motion in asked:
        options = [("--record", record) for record in records]
        options += [("--vertical", motion.vertical)] if motion.vertical else []
        options += [] if motion.scale is None else [("--scale", repr(motion.scale))]
        options += [("--scale-to", motion.scale_to)] if motion.scale_to else []
        histories.append([*words, *(word for option in options for word in option)])
    subjects = histories if folder is None else [[str(folder)]]
    pages = [["rps", "report", *each, *["--budget"] * with_budget] for each in subjects]
    without = given.case.record is None and not any(records for records, _ in asked)
    return pages if without else [*(["rps", HISTORY, *each] for each in histories), *pages]


def _stored(
    earlier: Earlier, requests: Sequence[HistoryRequest], document: Mapping[str, Any]
) -> Iterator[Block]:
    """Differences of case, records and results from the stored ones."""
    for request, record in zip(requests, earlier.records, strict=True):
        named = request.ground.named
        if any(record[n]["sha256"] != named[n].digest for n in ("horizontal", "y") if record[n]):
            yield Notice(f"The record {request.label} is no longer that of the stored results.")
    if (file := earlier.file) is not None:
        digest = hashlib.sha256(file.read_bytes()).hexdigest() if file.is_file() else ""
        if digest != earlier.run["sha256"]:
            state = "has changed since" if digest else "is not there any more"
            yield Notice(f"{file} {state}; this page keeps to the case in run.json.")
    if (earlier.folder / SUMMARY).exists():
        yield from compared(earlier.folder, document)


def compared(folder: Path, document: Mapping[str, Any]) -> list[Block]:
    """Stored results beside new ones: how many are the same, and those that are not."""
    try:
        before = results_of(read_json(folder / SUMMARY, {}))
    except (OSError, ValueError) as error:
        return [Notice(f"{folder / SUMMARY} cannot be read, so nothing was compared: {error}")]
    now = results_of(plain(document))
    # By what the record was scaled is a result; the aim that asked for it is computed once.
    names = [name for name in before if name in now and name != "record.scaled_to"]
    differing = [(n, as_text(before[n]), as_text(now[n])) for n in names if before[n] != now[n]]
    same = len(names) - len(differing)
    text = (
        f"The results in {folder} were computed again from what {folder / 'run.json'} says:"
        f" {same} of {len(names)} stored results are the same to the last digit."
    )
    if not differing:
        return [text]
    warning = f"{text} Different: {len(differing)}; this page shows what was computed again."
    return [
        Notice(warning),
        Table.of_texts(("result", "stored", "computed anew"), differing, words=1),
    ]
