"""The reference: commands from click, keys from the schema, reports, results, Python names."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping
from itertools import groupby
from pathlib import Path

import click
import formulas

import rpscli
from rpscli.analyses.result_quantities import EVERY
from rpscli.case.schema.case_file import CaseFile
from rpscli.case.schema.keys import KeyReference, key_references
from rpscli.case.study.schema import StudyFile
from rpscli.cli import program
from rpscli.commands.init import schema_of
from rpscli.report.study.registry import REPORTS
from rpscli.tools.design.keys import DesignFile

FORMATS = {
    "case": ("Keys of cases", CaseFile),
    "study": ("Keys of studies", StudyFile),
    "design": ("Keys of designs", DesignFile),
}
PYTHON: dict[str, tuple[str, tuple[str, ...]]] = {
    "case": ("Cases", ()),
    "model": (
        "Structures",
        (
            "contact.Contact", "podium.Device", "devices.ViscousDamper", "devices.FrictionDamper",
            "devices.Stop", "devices.Tendon", "devices.RollingResistance",
        ),
    ),
    "records": ("Ground motions", ("measures.ResponseSpectrum",)),
    "analyses": (
        "Analyses and their results",
        (
            "trace.Trace", "trace.Event", "trace.DeviceDemand", "trace.DeviceTrace",
            "trace.DirectionTrace", "results.Energy", "results.ColumnForces",
            "column_forces.AxialForces", "fixed_base.FixedBaseResponse", "modal.FixedBaseModes",
            "modal.UpliftedModes", "pushover.StoreyCurve", "pushover.CapacityCurve",
            "floor_spectra.FloorSpectra",
        ),
    ),
    "studies": ("Studies", ()),
    "errors": ("Errors", ("CaseError", "RecordError", "UsageError", "PluginError")),
}  # fmt: skip
"""Layers with public names, in the order of the pages, and what else their objects are made of."""


def plain(text: str) -> str:
    """Text of help and schema in Markdown: only what stands between backticks is code."""
    parts = re.split(r"(`+[^`]+`+)", text)
    return "".join(
        part if i % 2 else re.sub(r"([*_<>\[\]|$#\\])", r"\\\1", part)
        for i, part in enumerate(parts)
    )


# -- commands


def _commands(
    group: click.Group, ctx: click.Context
) -> Iterator[tuple[str, click.Command, click.Context]]:
    for name in group.list_commands(ctx):
        command = group.get_command(ctx, name)
        assert command is not None
        inner = click.Context(command, parent=ctx, info_name=name)
        yield inner.command_path, command, inner
        if isinstance(command, click.Group):
            yield from _commands(command, inner)


def commands() -> dict[str, str]:
    """Pages of all commands by their names, and the page that lists them."""
    root = click.Context(program, info_name="rps")
    pages, rows = {}, []
    for name, command, ctx in _commands(program, root):
        page = name.replace(" ", "-")
        rows.append((page, name, command.get_short_help_str(limit=200)))
        pages[f"reference/commands/{page}"] = _command_page(name, command, ctx)
    exits = plain(str(program.epilog))
    listed = "\n".join(
        f"| [`{name}`]({page}.md) | {plain(said)} |" for page, name, said in rows
    )
    toc = "\n".join(page for page, *_ in rows)
    pages["reference/commands/index"] = (
        f"# Commands\n\n| command | |\n|---|---|\n{listed}\n\n{exits}\n\n"
        f"```{{toctree}}\n:hidden:\n\n{toc}\n```\n"
    )
    return pages


def _command_page(name: str, command: click.Command, ctx: click.Context) -> str:
    usage = " ".join([name, *command.collect_usage_pieces(ctx)])
    said = "\n\n".join(
        " ".join(part.split()) for part in (command.help or "").split("\n\n")
    )
    parts = [f"# {name}\n", f"```text\n{usage}\n```\n", f"{plain(said)}\n"]
    parts.append(f"```{{program}} {name}\n```\n")
    for parameter in command.get_params(ctx):
        if isinstance(parameter, click.Argument):
            continue  # told by the usage
        record = parameter.get_help_record(ctx)
        if record is not None:
            names, meaning = record
            parts.append(f":::{{option}} {names}\n\n{plain(meaning)}\n:::\n")
    return "\n".join(parts)


# -- keys


def _symbol(text: str) -> str:
    formula = formulas.is_formula(text)
    return (
        f'<span class="formula">{formulas.typeset(text)}</span>'
        if formula
        else plain(text)
    )


def _key(key: KeyReference, theory: Mapping[str, str], *, index: bool) -> str:
    facts = (
        f"required{' in its section' * ('.' in key.key)}" if key.required else "",
        f"in {key.unit}" if key.unit not in {"", "-"} else "a number" * (key.unit == "-"),
        plain(key.bounds),
        " or ".join(f"`{word}`" for word in key.words),
        f"default `{key.default}`" if key.default is not None else "",
        f"symbol {_symbol(key.symbol)}" if key.symbol else "",
    )
    known = ", ".join(filter(None, facts))
    sections = [
        f"[{n}](/theory.md#{theory[n]})" for n in key.sections.split(", ") if n in theory
    ]
    enters = f" Theory, section {', '.join(sections)}." if sections else ""
    said = plain(key.meaning)
    said = said[:1].upper() + said[1:] + "." * (not said.endswith("."))
    head = f":::{{confval}} {key.key}" + "\n:no-index:" * (not index)
    return (
        f"{head}\n\n{said}{enters}"
        + f"\n\n{known[:1].upper()}{known[1:]}." * bool(known)
        + "\n:::\n"
    )


def _sections(
    keys: Iterable[KeyReference],
    theory: Mapping[str, str],
    known: Mapping[str, KeyReference],
) -> Iterator[str]:
    """A heading for each key that holds keys, and below it those that hold none."""
    members = list(keys)
    first = members[0].key
    for parent in (key for key in members if key.keys or key.key == first):
        if parent.key != first:
            yield f"### {parent.key}\n"
        yield _key(parent, theory, index=parent.key not in known)
        for key in members:
            if not key.keys and key.key.rpartition(".")[0] == parent.key:
                yield _key(key, theory, index=key.key not in known)


def _limits(
    keys: Iterable[KeyReference], theory: Mapping[str, str], *, index: bool
) -> Iterator[str]:
    """All limits in one table: what may stand below each of them is the same."""
    rows, below = [], {}
    for key in keys:
        if key.key.count(".") == 1:
            cells = (
                f"`{key.key.split('.')[1]}`",
                plain(key.meaning),
                key.unit,
                plain(key.bounds),
            )
            rows.append("| " + " | ".join(cells) + " |")
        elif key.key.count(".") > 1:
            name = key.key.split(".")[-1]
            below.setdefault(
                name, key._replace(key=f"limits.RESULT.{name}", unit="", bounds="")
            )
    yield "| limit | of | unit | must be |\n|---|---|---|---|\n" + "\n".join(rows) + "\n"
    yield from (_key(key, theory, index=index) for key in below.values())


def keys(theory: Mapping[str, str]) -> tuple[dict[str, str], dict[str, str]]:
    """Pages of the formats, and of each key a link to what explains it."""
    pages, places, known = {}, {}, {}
    for name, (title, model) in FORMATS.items():
        parts = [
            f"# {title}\n",
            " ".join((model.__doc__ or "").split("\n\n")[0].split()) + "\n",
        ]
        parts.append(
            "An editor completes and checks them by its [JSON schema](/schemas.md).\n"
        )
        shared = []
        groups = groupby(key_references(model), lambda key: key.key.split(".")[0])
        sections = [(section, list(group)) for section, group in groups]
        for section, members in sorted(sections, key=lambda each: len(each[1]) > 1):
            if name != "case" and all(known.get(key.key) == key for key in members):
                shared.append(section)
                continue
            if len(members) > 1:
                parts.append(f"## {section}\n")
            index = section not in {key.split(".")[0] for key in known}
            if section == "limits":
                parts.append(_key(members[0], theory, index=index))
                parts += _limits(members[1:], theory, index=index)
            else:
                parts += _sections(members, theory, known)
            for key in members:
                if "." in key.key:
                    limit = f"[`{key.key}`](/reference/{name}.md#limits)"
                    places.setdefault(
                        key.key,
                        limit if section == "limits" else f"{{confval}}`{key.key}`",
                    )
        if shared:
            parts.insert(
                2,
                f"As in a [case](case.md){' or a [study](study.md)' * (name != 'study')}: "
                f"{', '.join(f'`{section}`' for section in shared)}.\n",
            )
        known |= {key.key: key for key in key_references(model) if key.key not in known}
        pages[f"reference/{name}"] = "\n".join(parts)
    return pages, places


def reports(theory: Mapping[str, str]) -> dict[str, str]:
    """The page of all reports of studies and their options."""
    parts = [
        "# Reports of studies\n",
        "What may stand at `reports` of a study, and its options.\n",
    ]
    for name in REPORTS:
        options = REPORTS[name].options
        parts.append(f"## {name}\n\n{plain((options.__doc__ or '').split(chr(10))[0])}\n")
        parts += [
            _key(key._replace(key=f"{name}: {key.key}"), theory, index=True)
            for key in key_references(options)
            if not key.key.startswith("limits.")
        ]
    return {"reference/reports": "\n".join(parts)}


# -- results


def results() -> dict[str, str]:
    """The page of the table of results."""
    rows = []
    for each in EVERY.values():
        symbol = " " + each.symbol.replace("|", r"\vert ") if each.symbol else ""
        said = f"{plain(each.label)}{symbol}" + (
            f": {plain(each.meaning)}" if each.meaning else ""
        )
        least = " at least" if each.from_below else ""
        limit = f"`{each.name}: {each.limit}`{least}" if each.limit else ""
        rows.append(
            f"| `{each.name}` | {each.unit or '-'} | {said} | {limit} | {plain(each.needs)} |"
        )
    head = "| name | unit | what it is | as a limit | needs |\n|---|---|---|---|---|\n"
    return {
        "reference/results": "# Results\n\n"
        "Names in Python, JSON, CSV files, `limits` and `--fail-on`; "
        "units are those of CSV files and JSON.\n\n" + head + "\n".join(rows) + "\n"
    }


def schemas(folder: Path) -> dict[str, str]:
    """The page that links the JSON schemas, which are written into a folder of static files."""
    made = {name: schema_of(name) for name in ("case", "study", "design", "results")}
    folder.mkdir(parents=True, exist_ok=True)
    for name, schema in made.items():
        (folder / f"{name}.json").write_text(
            json.dumps(schema, indent=1), encoding="utf-8"
        )
    rows = "\n".join(
        f"- {{download}}`{name}.json </schemas/{name}.json>`" for name in made
    )
    return {
        "schemas": "# JSON schemas\n\n"
        "Of files, for editors and other programs, and of what commands "
        f"print with `--json`; `rps schema` prints the same.\n\n{rows}\n"
    }


# -- Python


def python() -> dict[str, str]:
    """Pages of all public Python names, by the layer that they come from."""
    groups: dict[str, list[str]] = {}
    for module, names in rpscli._HOMES.items():
        groups.setdefault(module.split(".")[0], []).extend(names.split())
    assert set(groups) <= set(PYTHON), "a layer has no page"
    pages = {}
    for layer, (title, more) in PYTHON.items():
        parts = [f"# {title}\n"]
        for name in sorted(
            groups[layer], key=lambda name: (not name[0].isupper(), name.lower())
        ):
            kind = (
                "autoclass" if isinstance(getattr(rpscli, name), type) else "autofunction"
            )
            parts.append(
                f"## {name}\n\n```{{eval-rst}}\n.. {kind}:: rpscli.{name}\n```\n"
            )
        for path in more:
            name = path.rpartition(".")[2]
            # What a device answers to the rest of the program concerns nobody else.
            members = (
                "   :no-members:\n" if path.startswith(("devices.", "podium.")) else ""
            )
            parts.append(
                f"## {name}\n\n"
                f"```{{eval-rst}}\n.. autoclass:: rpscli.{layer}.{path}\n{members}```\n"
            )
        pages[f"reference/python/{layer}"] = "\n".join(parts)
    for name in ("figures", "plugins"):
        pages[f"reference/python/{name}"] = (
            f"# rpscli.{name}\n\n```{{eval-rst}}\n.. automodule:: rpscli.{name}\n"
            "   :exclude-members: GroundMotion, RecordError, PluginError\n```\n"
        )
    listed = "\n".join(
        f"- [{title}]({layer}.md): {', '.join(f'`{name}`' for name in sorted(groups[layer]))}"
        for layer, (title, _) in PYTHON.items()
    )
    toc = "\n".join([*PYTHON, "figures", "plugins"])
    pages["reference/python/index"] = (
        "# Python\n\nAll quantities are in SI units.\n\n"
        f"{listed}\n- [rpscli.figures](figures.md) and [rpscli.plugins](plugins.md)\n\n"
        f"```{{toctree}}\n:hidden:\n\n{toc}\n```\n"
    )
    return pages
