"""`rps doctor`: what is installed, what is missing, and where rps keeps what it made."""

from __future__ import annotations

import locale
import os
import platform
import re
import shutil
import sys
from importlib import metadata, resources
from pathlib import Path
from typing import Any

import click

from rpscli.commands.init import shipped_cases
from rpscli.commands.shell.options import terminal_options
from rpscli.commands.shell.terminal import Terminal
from rpscli.errors import VerificationMismatch
from rpscli.machine import available_cores
from rpscli.registry import Registry
from rpscli.report.figures.look import ENCODER, font_file
from rpscli.report.files import heading, installed
from rpscli.report.table import Table
from rpscli.user_cache import VARIABLE, cache_places, user_cache
from rpscli.version import VERSION

EXTRAS = {
    "records": "the ground motions of FEMA P695",
    "cluster": "studies on a Dask cluster",
    "contact": "bodies in contact, rps export CASE mujoco",
}
"""Uses of packages that users may do without."""

KINDS = (
    "formats",
    "measures",
    "targets",
    "reports",
    "figures",
    "dampers",
    "impact_laws",
    "commands",
)
"""Groups of entry points."""


@click.command("doctor")
@terminal_options
def command(terminal: Terminal) -> None:
    """Show what is installed, what is missing, and the remedy; exit
    code 6 if it cannot run.
    """
    needed = _packages(None)
    optional = [row for extra in EXTRAS for row in _packages(extra)]
    # Entry points of other packages: group and name, package, and why it does not load.
    offers = (offer for kind in KINDS for offer in Registry(kind, {}, Any).offers())
    added = [
        (f"rpscli.{each.kind}: {each.name}", each.package, each.fault) for each in offers
    ]
    rows = [*_surroundings(), *needed, *optional, *added]
    table = Table.of_texts(("subject", "found", "remedy, or what it adds"), rows, words=3)
    findings = [
        dict(zip(("subject", "found", "remedy"), row, strict=True)) for row in rows
    ]
    lacking = "\n".join(
        f"{name}: {found}; {remedy}" for name, found, remedy in needed if remedy
    )
    error = VerificationMismatch(lacking) if lacking else None
    document = {**heading("doctor"), "findings": findings}
    # Without rich there are no tables: then the errors say it.
    terminal.finish(document, [table] if installed("rich") else (), error)


def _surroundings() -> list[tuple[str, str, str]]:
    anew = (
        ""
        if installed("rpscli") == VERSION
        else "pip install rpscli: this runs from a folder"
    )
    place = user_cache()
    encoder = shutil.which(ENCODER)
    mine = (
        ""
        if place in cache_places()[:1]
        else f"set {VARIABLE} to a folder that is yours alone"
    )
    return [
        ("rps", f"{VERSION}, cases in {shipped_cases()}", anew),
        (
            "GUIDE.md, THEORY.md, GLOSSARY.md",
            f"in {Path(str(resources.files('rpscli')))}",
            "",
        ),
        ("Python", f"{platform.python_version()}, {sys.executable}", ""),
        ("system", f"{platform.platform()}, text in {locale.getencoding()}", ""),
        ("cores", str(available_cores()), ""),
        *_processor(),
        ("cache", f"{place}, {_size(place)}, may be deleted" if place else "-", mine),
        (
            "font of figures",
            font_file() if place and installed("matplotlib") else "-",
            "",
        ),
        (ENCODER, encoder or "-", "" if encoder else "animations as MP4"),
    ]


def _processor() -> list[tuple[str, str, str]]:
    """Row for the processor for which kernels are compiled."""
    if not installed("llvmlite"):
        return []
    from rpscli.compiler.objects import can_fuse, processor

    slow = "" if can_fuse() else "it has no FMA: studies take some ten times as long"
    return [("processor", processor().split(" ")[1], slow)]


def _packages(extra: str | None) -> list[tuple[str, str, str]]:
    """Packages that rps needs, or that one of its extras
    brings: name, version, remedy.
    """
    rows = []
    for text in metadata.requires("rpscli") or [] if installed("rpscli") else []:
        said = re.match(r"([\w.-]+)>=([\d.]+)(?:.*extra == .(\w+))?", text)
        if said and said[3] == extra:
            version = installed(said[1]) or "-"
            adds = f'pip install "rpscli[{extra}]": {EXTRAS[extra]}' if extra else ""
            lacks = _numbers(version) < _numbers(said[2])
            remedy = adds or f'pip install "{said[1]}>={said[2]}"'
            rows.append((said[1], version, remedy if lacks else ""))
    return rows


def _numbers(version: str) -> list[int]:
    return [int(number) for number in re.findall(r"\d+", version)]


def _size(folder: Path) -> str:
    """Of all files in a folder."""
    files = (each for each in (folder, *folder.rglob("*")) if os.path.lexists(each))
    return f"{sum(each.lstat().st_size for each in files) / 1e6:.1f} MB"
