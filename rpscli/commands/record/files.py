"""A ground motion into one file, for `convert` and `synth`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from rpscli.commands.case_input import write
from rpscli.commands.record.info import record_tables
from rpscli.commands.record.input import record_folder
from rpscli.commands.shell.options import OutputRequest
from rpscli.commands.shell.terminal import Terminal
from rpscli.errors import Refused, UsageError
from rpscli.report.documents import heading
from rpscli.report.files.whole_files import write_whole

if TYPE_CHECKING:
    from rpscli.records.ground_motion import GroundMotion

FORMATS = {"at2": ".at2", "text": ".txt"}
"""Formats that can be written, and how their files are called."""


def write_record(
    command: str,
    motion: GroundMotion,
    output: OutputRequest,
    terminal: Terminal,
    form: str | None,
) -> None:
    """Write the motion into the folder, or the file, that the command line names."""
    from rpscli.records.measures import intensity_measures
    from rpscli.report.tables.record import record_document

    named = _named_format(output.place)
    if named and form not in {None, named}:
        raise UsageError(f"--to {form}: contradicts the file name {output.place}")
    wanted = named or form or "at2"
    content = _text(motion, wanted)
    if named and output.place is not None:
        files = _one_file(output.place, content, output, terminal)
    else:
        folder = record_folder(motion, output, command, format=wanted)
        folder.add(f"{motion.name}{FORMATS[wanted]}", content)
        write(folder, terminal)
        files = folder.files
    measures = intensity_measures(motion)
    document = {
        **heading(),
        "command": f"record {command}",
        **record_document(motion, measures),
        "files": files,
    }
    terminal.result(document, record_tables(motion, measures))


def _named_format(place: Path | None) -> str | None:
    """The format that a file name asks for; None for a folder."""
    if place is None or place.is_dir():
        return None
    return next((form for form, end in FORMATS.items() if place.suffix.lower() == end), None)


def _one_file(path: Path, content: str, output: OutputRequest, terminal: Terminal) -> list[str]:
    if path.exists() and not output.force:
        raise Refused(f"{path} exists; name another file, or overwrite it with --force")
    write_whole({path: content.encode()})
    terminal.note(f"written to {path}")
    return [str(path)]


def _text(motion: GroundMotion, form: str) -> str:
    from rpscli.records.formats.at2 import at2_text
    from rpscli.report.tables.record import two_column_text

    return at2_text(motion) if form == "at2" else two_column_text(motion)
