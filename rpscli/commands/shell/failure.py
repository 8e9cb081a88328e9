"""The one place that turns errors into text, a JSON document and an exit code."""

from __future__ import annotations

import os
import re
import sys
import traceback
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click

from rpscli.commands.shell.terminal import emit
from rpscli.errors import LimitExceeded, RpsError, visible
from rpscli.report.documents import failure_document, json_text

INTERRUPTED = 130
INTERNAL = 1
TRACEBACK = "RPS_TRACEBACK"
"""Environment variable that asks for the traceback of an internal error."""


def exit_code_of(error: BaseException) -> int:
    """The exit code that stands for an error."""
    if isinstance(error, RpsError | click.ClickException):
        return error.exit_code
    return INTERRUPTED if isinstance(error, KeyboardInterrupt | click.Abort) else INTERNAL


def report(error: BaseException, *, as_json: bool) -> int:
    """Say on the streams what went wrong; returns the exit code."""
    code = exit_code_of(error)
    if as_json:
        document = failure_document(kind(error), message(error), code)
        emit(json_text(document), sys.stdout)
    emit(_lines(error), sys.stderr)
    return code


def concluded(document: Mapping[str, Any], error: RpsError | None) -> dict[str, Any]:
    """The document of a result with its exit code; status ``ok`` although a limit is exceeded."""
    code = 0 if error is None else error.exit_code
    end = {"passed": code == 0, "exit_code": code}
    if error is None or isinstance(error, LimitExceeded):
        return {**document, **end}
    return {**document, **failure_document(kind(error), message(error), code)}


def leave(error: RpsError | None) -> None:
    """End a command that has given its result, if an error belongs to it."""
    if error is not None:
        emit(_lines(error), sys.stderr)
        raise click.exceptions.Exit(error.exit_code)


def kind(error: BaseException) -> str:
    """Name of an error in JSON: its class; all faults of the command line are one kind."""
    if isinstance(error, click.ClickException):
        return "UsageError"
    return "Interrupted" if exit_code_of(error) == INTERRUPTED else type(error).__name__


def message(error: BaseException) -> str:
    """What an error says, without its kind; words of hundreds of letters are cut."""
    # The end of a path says most of it.
    return re.sub(r"\S{301,}", lambda word: f"{word[0][:140]}...{word[0][-140:]}", _message(error))


def _message(error: BaseException) -> str:
    if isinstance(error, click.ClickException):
        return error.format_message()
    if exit_code_of(error) == INTERRUPTED:
        return "interrupted; no file was changed"
    if isinstance(error, RpsError):
        return str(error)
    if isinstance(error, OSError):
        named = f"{str(error.filename)[:200]}: " if error.filename else ""
        return f"{named}{error.strerror or error}; check the path, its permissions and the disk"
    if isinstance(error, MemoryError | RecursionError):
        return "there is not enough memory; use fewer points, samples or storeys"
    place = traceback.extract_tb(error.__traceback__)[-1:]
    where = f" ({Path(place[0].filename).name}:{place[0].lineno})" if place else ""
    return (
        f"internal error{where}: {type(error).__name__}: {error}; this is a fault of rps: please"
        f" report it with the traceback that {TRACEBACK}=1 shows"
    )


def _lines(error: BaseException) -> str:
    if exit_code_of(error) == INTERNAL and os.environ.get(TRACEBACK):
        return "".join(traceback.format_exception(error))
    if type(error).__name__ == "NoArgsIsHelpError":  # click >= 8.2: a group without a subcommand
        return f"{message(error)}\n"
    usage = ""
    if isinstance(error, click.UsageError) and error.ctx is not None:
        usage = f"{error.ctx.get_usage()}\ntry {error.ctx.command_path} --help\n"
    return usage + "".join(f"error: {line}\n" for line in visible(message(error)).splitlines())
