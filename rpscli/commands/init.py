"""`rps init`, `rps schema` and `rps completion`: what helps to
write files and commands.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping
from keyword import iskeyword
from pathlib import Path
from typing import Any

import click
from click.shell_completion import BashComplete, FishComplete, ZshComplete

from rpscli.case.text.file_kinds import FILE_KINDS
from rpscli.commands.shell.options import completing, terminal_options
from rpscli.commands.shell.terminal import Terminal, emit
from rpscli.errors import Refused, UsageError, hint, listed
from rpscli.report.files import heading, json_text, write_whole
from rpscli.report.table import Table

FOLDER = "cases"
_FILE_NAMES = re.compile(r"[\w./-]+\.(?:yaml|csv|at2|py)\b")


def shipped_cases() -> Path:
    """The folder of all of them."""
    inside = Path(__file__).resolve().parents[1] / FOLDER
    return inside if inside.is_dir() else inside.parents[1] / FOLDER


def examples() -> dict[str, str]:
    """Their names, as in `studies/product`, and the first sentence
    of what stands above each.
    """
    place = shipped_cases()
    sentences = {}
    for file in sorted(place.rglob("*.yaml"), key=lambda file: (len(file.parts), file)):
        above = (
            file.read_text("utf-8").partition("\nrps:")[0].replace("\n#", "").lstrip("# ")
        )
        name = file.relative_to(place).with_suffix("").as_posix()
        sentences[name] = re.split(r"(?<=[.?])\s", above)[0]
    return sentences


def example_files(name: str) -> dict[str, bytes]:
    """An example, or all of a folder, and the files that they name,
    in comments too, by path.
    """
    place = shipped_cases()
    contents: dict[Path, bytes] = {}
    waiting = [
        place / f"{name}.yaml",
        *sorted((place / name).rglob("*.yaml"), reverse=True),
    ]
    while waiting:
        file = waiting.pop()
        if file in contents or not file.is_file() or place not in file.parents:
            continue
        contents[file] = file.read_bytes()
        if file.suffix == ".yaml":
            # Beside the file, or as commands are typed, from above the folder.
            named = ["README.md", *_FILE_NAMES.findall(contents[file].decode("utf-8"))]
            waiting += [
                (up / each).resolve()
                for each in named
                for up in (file.parent, place.parent)
            ]
    return {
        file.relative_to(place).as_posix(): content for file, content in contents.items()
    }


TEMPLATE = "rps-example"
"""Name of the package that is written under another name."""


def package_files(name: str) -> dict[str, bytes]:
    """A package with one of everything that may be added to rps,
    of another name, by path.
    """
    module = name.replace("-", "_")
    taken = module in {*sys.stdlib_module_names, "rpscli"} or iskeyword(module)
    if not re.fullmatch(r"[a-z][a-z0-9]*([-_][a-z0-9]+)*", name) or taken:
        raise UsageError(
            f"--package {name}: must be small letters, digits, - and _, a letter first,"
            " and no module of Python or rps, as in my-dampers"
        )
    here = Path(__file__).resolve()
    inside = here.parents[1] / "example_package"
    place = inside if inside.is_dir() else here.parents[2] / "tests" / inside.name
    files = {}
    for file in (place / each for each in ("pyproject.toml", "README.md")):
        files[file.name] = file.read_text("utf-8")
    code = TEMPLATE.replace("-", "_")
    files[f"{code}.py"] = (place / f"{code}.py").read_text("utf-8")
    return {
        path.replace(code, module): text.replace(TEMPLATE, name)
        .replace(code, module)
        .encode()
        for path, text in files.items()
    }


@click.command("init")
@click.argument("file", required=False, type=click.Path(path_type=Path))
@click.option("--study", is_flag=True, help="A study in place of a case.")
@click.option(
    "--example",
    is_flag=False,
    flag_value="",
    metavar="[NAME]",
    **completing(examples),
    help=(
        "Write a case or study that comes with rps, or a folder of them, and the files"
        " that they name, into the folder FILE (cases by default); without NAME, list"
        " them."
    ),
)
@click.option(
    "--editor",
    is_flag=True,
    help=(
        "Also write the schema beside FILE, and a first line by which editors that know"
        " the YAML language server check and complete what is typed."
    ),
)
@click.option(
    "--package",
    metavar="NAME",
    help=(
        "Write a Python package with one of everything that may be added to rps (a"
        " damper, a measure, a report, ...) into the folder FILE (NAME by default)."
    ),
)
@click.option("--force", is_flag=True, help="Overwrite files that exist.")
@terminal_options
def command(
    file: Path | None,
    example: str | None,
    package: str | None,
    *,
    study: bool,
    editor: bool,
    force: bool,
    terminal: Terminal,
) -> None:
    """Write a commented case to FILE (case.yaml or study.yaml
    by default; - prints it).
    """
    if example is not None or package is not None:
        both = example is not None and package is not None
        if both or study or editor or str(file) == "-":
            raise UsageError(
                f"{'--package' if example is None else '--example'} writes files as they"
                " are into a folder; leave out the rest"
            )
        if package is not None:
            _package(package, file or Path(package), terminal, force=force)
        else:
            _example(example or "", file or Path(FOLDER), terminal, force=force)
        return
    from rpscli.case.text.files import starter_text

    text = starter_text(study=study)
    kind = "study" if study else "case"
    file = file or Path(f"{kind}.yaml")
    if str(file) == "-":
        if editor:
            raise UsageError(
                "--editor writes the schema beside FILE; name a file in place of -"
            )
        emit(text, sys.stdout)
        return
    files = {file: text}
    if editor:
        schema = file.with_name(f"rps-{kind}.schema.json")
        files[file] = f"# yaml-language-server: $schema={schema.name}\n{text}"
        files[schema] = json_text(schema_of(kind))
    _write(
        {each: content.encode() for each, content in files.items()}, terminal, force=force
    )


def _example(name: str, folder: Path, terminal: Terminal, *, force: bool) -> None:
    known = examples()
    name = name.removesuffix(".yaml").removeprefix(f"{FOLDER}/")
    if not name:
        document = {**heading("init"), "files": [], "examples": known}
        terminal.result(document, [Table.listing(known.items())])
        return
    files = {folder / path: content for path, content in example_files(name).items()}
    if not files:
        meant = hint(name, known, "`rps init --example` lists all")
        raise UsageError(f"--example {name}: there is none of this name; {meant}")
    _write(files, terminal, force=force)


def _package(name: str, folder: Path, terminal: Terminal, *, force: bool) -> None:
    files = {folder / path: content for path, content in package_files(name).items()}
    _write(files, terminal, f"pip install -e {folder}", force=force)


def _write(
    files: Mapping[Path, bytes], terminal: Terminal, then: str = "", *, force: bool
) -> None:
    """All of the files, of which the first is what was asked for; the
    same may be there already. What to do `then` is said.
    """
    for each, content in files.items():
        if each.exists() and not force and each.read_bytes() != content:
            raise Refused(
                f"{each} exists; name another file, or overwrite it with --force"
            )
    write_whole(files)
    first, *others = files
    also = f" with {listed(map(str, others), 'and')}" if others else ""
    terminal.note(f"written to {first}{also}; next: {then or _next(first, files[first])}")
    if terminal.as_json:
        terminal.result({**heading("init"), "files": [str(each) for each in files]})


def _next(file: Path, content: bytes) -> str:
    """The command that looks at a file that was written."""
    # What names a base is a study, or a file of a tool.
    keys = {*re.findall(r"^(\w+):", content.decode(), re.MULTILINE)}
    others_kind = (name for name, kind in FILE_KINDS.items() if kind.marks & keys)
    verb = next(others_kind, "sweep")
    return (
        f"rps {verb} {file} --dry-run" if b"\nbase:" in content else f"rps check {file}"
    )


FORMATS = ("case", "study", *FILE_KINDS)


@click.command("schema")
@click.argument(
    "what",
    metavar=f"[{'|'.join(FORMATS)}]",
    default="case",
    **completing(lambda: FORMATS),
)
@terminal_options
def schema(*, what: str, terminal: Terminal) -> None:
    """Print the JSON schema of a case file, a study (with the options of
    all reports) or a design.

    Editors that know YAML check and complete a file by it: `rps init --editor`.
    """
    del terminal
    if what not in FORMATS:
        raise UsageError(f"schema {what}: the schemas are those of {', '.join(FORMATS)}")
    emit(json_text(schema_of(what)), sys.stdout)


def schema_of(what: str) -> dict[str, Any]:
    """The schema of cases, of studies or of the files of a tool."""
    # pydantic is slow.
    if what == "case":
        from rpscli.case.schema.case_file import CaseFile
        from rpscli.case.schema.keys import json_schema_of

        return json_schema_of(CaseFile)
    from rpscli.case.schema.keys import study_json_schema
    from rpscli.case.study.reports import format_with
    from rpscli.report.study.registry import REPORTS

    if what in FILE_KINDS:
        return study_json_schema(FILE_KINDS[what].model)
    return study_json_schema(format_with(REPORTS.everything()))


SHELLS = {"bash": BashComplete, "zsh": ZshComplete, "fish": FishComplete}


@click.command("completion")
@click.argument("shell", type=click.Choice(tuple(SHELLS)))
def completion(shell: str) -> None:
    """Print the lines with which SHELL completes commands,
    options, files, keys and names.

    For bash put `eval "$(rps completion bash)"` into ~/.bashrc, for zsh the same with zsh
    into ~/.zshrc; for fish, `rps completion fish > ~/.config/fish/completions/rps.fish`.
    """
    complete = SHELLS[shell](click.Command("rps"), {}, "rps", "_RPS_COMPLETE")
    # Not `source()`, which for bash first asks the version of a bash that need not be
    # here.
    emit(complete.source_template % complete.source_vars() + "\n", sys.stdout)
