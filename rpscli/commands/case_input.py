"""From what stands on the command line to a case and to the folder of its results."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rpscli.commands.shell.options import CaseRequest, OutputRequest
from rpscli.commands.shell.terminal import Terminal
from rpscli.errors import CaseError
from rpscli.report.files.output_folder import OutputFolder, Run

if TYPE_CHECKING:
    from rpscli.case.case import Case

RESULTS = Path("results")
"""Where results go by default, below the working folder."""


@dataclass(frozen=True, eq=False)
class CaseInput:
    """A case, and where it came from."""

    case: Case
    request: CaseRequest

    @property
    def file(self) -> Path | None:
        """The case file; None if it came through the standard input."""
        return None if self.request.source == "-" else Path(self.request.source)


def read_case(request: CaseRequest, terminal: Terminal) -> CaseInput:
    """Read and check a case; its warnings go to the terminal."""
    from rpscli.case.case import load_case

    case = load_case(request.source, request.overrides)
    terminal.warn(case.warnings)
    return CaseInput(case, request)


def read_cases(requests: Iterable[CaseRequest], terminal: Terminal) -> list[CaseInput]:
    """Read and check several cases; the faults of all are raised together."""
    cases, complaints = [], []
    for request in requests:
        try:
            cases.append(read_case(request, terminal))
        except CaseError as error:
            complaints.append(str(error))
    if complaints:
        raise CaseError("\n".join(complaints))
    return cases


def case_folder(
    given: CaseInput,
    output: OutputRequest,
    command: str,
    *,
    record_source: Path | str | None = None,
    **inputs: Any,
) -> OutputFolder:
    """The folder of a command's results, claimed before the work begins.

    Parameters
    ----------
    record_source
        The record that the results belong to besides the case, if they do.
    inputs
        Everything else that decides about them.
    """
    resolved: Mapping[str, Any] = {
        "case": given.case.document,
        "overrides": list(given.request.overrides),
        **inputs,
    }
    run = Run(command, given.case.name, given.file, given.case.digest, resolved, record_source)
    place = output.place or RESULTS / given.case.name / command
    return OutputFolder(place, run, force=output.force)


def write(folder: OutputFolder, terminal: Terminal) -> None:
    """Write all that was collected, and say where."""
    replaced = folder.replaces_other_inputs
    folder.write()
    note = "; replaces results of the same case with other inputs" if replaced else ""
    terminal.note(f"written to {folder.folder}{note}")


def case_heading(given: CaseInput) -> dict[str, str]:
    """The case in a JSON document."""
    return {"name": given.case.name, "title": given.case.title, "source": given.case.source}
