"""The page of a case, of its time history if it has a record, and of stored results of one."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rpscli.analyses.result_quantities import plain
from rpscli.commands.inputs import CaseInput, MotionRequest, case_heading
from rpscli.commands.shell.failure import concluded
from rpscli.commands.shell.options import CaseRequest, OutputRequest
from rpscli.commands.shell.terminal import Terminal
from rpscli.commands.shell.waiting import announce_compilation
from rpscli.commands.timehistory_run import HistoryRequest, HistoryResult, compute, history_requests
from rpscli.errors import UsageError
from rpscli.report.documents import heading
from rpscli.report.figures.look import Look
from rpscli.report.files import RUN_FILE
from rpscli.report.html.page import Block, Notice, Section, page_look
from rpscli.report.table import Table

if TYPE_CHECKING:
    from rpscli.case.conditions import Condition
    from rpscli.errors import RpsError

SUMMARY = "summary.json"
HISTORY, SWEEP = "timehistory", "sweep"


@dataclass(frozen=True)
class Earlier:
    """A folder of earlier results, and what its `run.json` says."""

    folder: Path
    run: Mapping[str, Any]

    @property
    def file(self) -> Path | None:
        """The case or the study, as seen from the working folder."""
        name = self.run["file"]
        return None if name is None else _shortened(self.folder / name)


def earlier_results(folder: Path) -> Earlier:
    """What a folder holds."""
    command = None
    try:
        run = json.loads((folder / RUN_FILE).read_text(encoding="utf-8"))
        command, inputs = run["command"], run["inputs"]
        needed = [*(run[key] for key in ("file", "name", "sha256")), inputs["overrides"]]
        if command == HISTORY:
            record = inputs["record"]
            needed += [inputs["case"], record["scale"], record["vertical"]]
            needed += [record["horizontal"][key] for key in ("source", "sha256")]
        if command in {HISTORY, SWEEP}:
            return Earlier(folder, run)
    except (OSError, ValueError, TypeError, KeyError):
        pass  # told below, together with folders of other commands
    inside = sorted(path.parent for path in folder.glob(f"*/{RUN_FILE}"))
    hint = f"; name one of the folders in it, such as {inside[0]}" if inside else ""
    what = f"holds results of `rps {command}`" if command else f"has no {RUN_FILE} of rps"
    raise UsageError(
        f"{folder}: {what}, and a report is made of one time history or one study{hint}"
    )


def is_study(source: str) -> bool:
    """Whether a file is a study: these have a case at their base."""
    if source == "-":
        return False
    from rpscli.case.text.files import read_text
    from rpscli.case.text.yaml_text import read_yaml

    return "base" in read_yaml(read_text(source), source).content


def earlier_case(earlier: Earlier) -> tuple[CaseInput, MotionRequest]:
    """The case and the motion of earlier results, as they were then."""
    from rpscli.case.case import parse_case

    run, file = earlier.run, earlier.file
    folder = earlier.folder if file is None else file.parent
    name = str(file or f"{run['name']}.yaml")
    # JSON is YAML too.
    case = parse_case(json.dumps(run["inputs"]["case"]), name=name, folder=folder)
    case = replace(case, digest=run["sha256"])
    request = CaseRequest(name, tuple(run["inputs"]["overrides"]))
    given, own = run["inputs"]["record"], case.record
    horizontal, vertical = (
        None if given[name] is None else str(given[name]["source"])
        for name in ("horizontal", "vertical")
    )
    if own is not None and own.source == horizontal:
        horizontal, vertical = None, None if vertical == own.vertical else vertical
    return CaseInput(case, request), MotionRequest(horizontal, vertical, given["scale"])


def _shortened(path: Path) -> Path:
    """Without steps back and forth, and relative where that is shorter."""
    absolute = path.resolve()
    here = Path.cwd()
    return absolute.relative_to(here) if absolute.is_relative_to(here) else absolute


@dataclass(frozen=True)
class PageDone:
    """A page's title and sections, the document that says what was found, and its error."""

    title: str
    subtitle: str
    sections: Sequence[Section]
    document: dict[str, Any]
    error: RpsError | None


def case_page(
    given: CaseInput,
    motion: MotionRequest,
    conditions: Sequence[Condition],
    look: Look,
    earlier: Earlier | None,
    terminal: Terminal,
) -> PageDone:
    """Compute what belongs to a case, and put it in order."""
    from rpscli.report.html.case_page import History, case_sections

    case = given.case
    made = partial(case_sections, case, given.request.overrides, _commands(given, motion), look)
    if case.record is None and motion.record is None:
        document = {**heading(), "case": case_heading(given), "warnings": list(case.warnings)}
        sections = made(case.warnings)
        return PageDone(case.title, "Structure", sections, concluded(document, None), None)
    # A place for the files, which are not written there.
    (request,) = history_requests([given], [motion], OutputRequest(Path(), force=True))
    announce_compilation(terminal, moving=True)
    done, result = compute(request, conditions, page_look(look), terminal)
    warnings = done.document["warnings"]
    terminal.warn(warnings)
    stored = () if earlier is None else _stored(earlier, request, done)
    files = [(path.name, content) for path, content in request.folder.contents.items()]
    history = History(request.ground, result, done.verdicts, files)
    return PageDone(
        case.title,
        f"Time history under {result.record.name}",
        made(warnings, history, stored),
        done.document,
        done.error,
    )


def subject_words(source: str, overrides: Iterable[str]) -> list[str]:
    """A case or a study on a command line, with what is put over it."""
    return [source, *(word for override in overrides for word in ("--set", override))]


def _commands(given: CaseInput, motion: MotionRequest) -> list[list[str]]:
    """That make the same again."""
    words = subject_words(given.request.source, given.request.overrides)
    options = {
        "--record": motion.record,
        "--vertical": motion.vertical,
        "--scale": None if motion.scale is None else repr(motion.scale),
        "--scale-to": motion.scale_to,
    }
    for option, value in options.items():
        words += [] if value is None else [option, value]
    without = given.case.record is None and motion.record is None
    return [["rps", command, *words] for command in ("timehistory", "report")[without:]]


def _stored(earlier: Earlier, request: HistoryRequest, done: HistoryResult) -> list[Block]:
    """Whether case, record and results are those of the stored results."""
    found: list[Block] = []
    file = earlier.file
    known = earlier.run["inputs"]["record"]["horizontal"]["sha256"]
    if request.ground.horizontal.digest != known:
        found.append(Notice("The record is not the one of the stored results any more."))
    if file is not None:
        try:
            now = hashlib.sha256(file.read_bytes()).hexdigest()
        except OSError:
            now = ""
        if now != earlier.run["sha256"]:
            state = "has changed since" if now else "is not there any more"
            found.append(Notice(f"{file} {state}; this page keeps to the case in run.json."))
    if (earlier.folder / SUMMARY).exists():
        found += compared(earlier.folder, done.document)
    return found


MADE_ANEW = frozenset(
    ("files", "rps_version", "case", "verdicts", "passed", "exit_code", "command")
)
"""Keys that are no results."""


def compared(folder: Path, document: Mapping[str, Any]) -> list[Block]:
    """What became of the stored results: how many are the same, and those that are not."""
    try:
        stored = json.loads((folder / SUMMARY).read_text(encoding="utf-8"))
        before = dict(_leaves(stored))
    except (OSError, ValueError, AttributeError) as error:
        return [Notice(f"{folder / SUMMARY} cannot be read, so nothing was compared: {error}")]
    now = dict(_leaves(plain(document)))
    names = [name for name in before if name in now]
    differing = [(n, _text(before[n]), _text(now[n])) for n in names if before[n] != now[n]]
    same = len(names) - len(differing)
    text = (
        f"The results in {folder} were computed anew from what {folder / 'run.json'} says:"
        f" {same} of {len(names)} stored results are the same to the last digit."
    )
    if not differing:
        return [text]
    warning = f"{text} {len(differing)} differ; this page shows what was computed anew."
    return [
        Notice(warning),
        Table.of_texts(("result", "stored", "computed anew"), differing, words=1),
    ]


def _leaves(document: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in document.items():
        if not prefix and name in MADE_ANEW:
            continue
        if isinstance(value, dict):
            yield from _leaves(value, f"{prefix}{name}.")
        else:
            yield prefix + name, value


def _text(value: object) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) < 60 else f"{text[:57]}..."
