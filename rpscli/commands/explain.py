"""`rps explain`: what a key, a result or a word means."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from importlib import resources
from typing import TYPE_CHECKING

import click

from rpscli.analyses.result_quantities import EVERY, ResultQuantity
from rpscli.commands.shell.options import completing, terminal_options
from rpscli.commands.shell.terminal import Terminal
from rpscli.errors import UsageError, hint
from rpscli.report.documents import heading
from rpscli.report.table import Heading, Part, Table

if TYPE_CHECKING:
    from rpscli.case.schema.keys import KeyReference
    from rpscli.registry import Offer

BEARING = """\
      <- 2B ->
     .--------.     ---
   .'          '.    |   R      from the centre to an end of
   |<--- 2B' -->|    |          the flat part, 2B wide
   |            |    |   alpha  between R and the axis:
   |      +     |   2H          tan(alpha) = B/H
   |            |    |   alpha' to the edge of the arc:
   |            |    |          tan(alpha') = B'/H
   '.          .'    |   rho    r/2H, r the radius of the
     '--------'     ---         arcs between B and B'
"""
PLUGINS = "plugins"
"""The word for what other packages add."""
DRAWINGS = {"podium.bearing": BEARING}
"""Small drawings of what sections describe."""


def _words() -> list[str]:
    """What may be asked for: keys, their ends, results, reports and words."""
    from rpscli.report.study.registry import REPORTS

    keys = [key.key for key in _formats()]
    names = [name for entry, _ in glossary() for name in _names(entry)]
    ends = [key.rsplit(".", 1)[-1] for key in keys]
    return list(dict.fromkeys([*keys, *ends, *EVERY, *REPORTS, *names]))


@click.command("explain")
@click.argument("word", metavar="KEY", **completing(_words))
@terminal_options
def command(word: str, terminal: Terminal) -> None:
    """What KEY means: a key of cases or studies, a report, a result, a symbol, a word of tables.

    Keys are named in full (podium.bearing.slenderness), by their end (slenderness) or by their
    symbol (rho). `plugins` lists what other packages add.
    """
    # pydantic is slow.
    from rpscli.case.schema.keys import key_references
    from rpscli.report.study.registry import REPORTS

    keys = _keys(word)
    words = [row for row in glossary() if word.lower() in _names(row[0])]
    results = [q for q in EVERY.values() if word == q.name or (word == q.label and not words)]
    offers = [] if (keys or results or words) else list(_offers(word))
    report = (REPORTS.everything() if offers else REPORTS).get(word)
    reports = [] if report is None else [(word, (report.options.__doc__ or "").split("\n")[0])]
    # Ranges of values of each limit are told at the limits of studies.
    options = [
        (f"option {key.key}", key)
        for key in (() if report is None else key_references(report.options))
        if not key.key.startswith("limits.")
    ]
    if not (keys or results or words or offers or report):
        options = list(_options(word))
    if not (keys or results or words or options or offers or word == PLUGINS):
        instead = hint(word, _words(), "`rps explain podium` and the like list a section's keys")
        raise UsageError(f"explain {word}: there is no such name; {instead}")
    document = {
        **heading("explain"),
        "word": word,
        "keys": [key._asdict() for key in keys],
        "results": [{name: value for name, value in q._asdict().items() if value} for q in results],
        "words": [{"word": name, "meaning": meaning} for name, meaning in words],
        "reports": [{"report": name, "meaning": meaning} for name, meaning in reports],
        "options": [key._asdict() for _, key in options],
        "plugins": [offer._asdict() for offer in offers],
    }
    parts = [*_tables(keys, results, words, reports, options), *_plugins(word, offers)]
    terminal.result(document, parts)


def _offers(word: str) -> Iterator[Offer]:
    """What other packages add: all for the word plugins, else what is called so."""
    from rpscli.records.codes import CODES
    from rpscli.records.formats import FORMATS
    from rpscli.records.measures import MEASURES
    from rpscli.report.figures.look import FIGURES
    from rpscli.report.study.registry import REPORTS

    for registry in (FORMATS, MEASURES, CODES, REPORTS, FIGURES):
        if word == PLUGINS or (word not in registry and word in registry.names()):
            yield from (each for each in registry.offers() if word in {PLUGINS, each.name})


def _plugins(word: str, offers: Sequence[Offer]) -> Iterator[Part]:
    if word == PLUGINS and not offers:
        yield "no installed package adds anything; help(rpscli.plugins) explains how to write one"
    elif offers:
        heads = ("group", "name", "package", "is")
        rows = [(f"rpscli.{o.kind}", o.name, o.package, o.fault or o.meaning) for o in offers]
        yield Table.of_texts(heads, rows, words=len(heads))


def _formats() -> list[KeyReference]:
    """Every key of the three formats, once."""
    # pydantic is slow.
    from rpscli.case.design import DesignFile
    from rpscli.case.schema.case_file import CaseFile
    from rpscli.case.schema.keys import key_references
    from rpscli.case.study.schema import StudyFile

    known: dict[str, KeyReference] = {}
    for model in (CaseFile, StudyFile, DesignFile):
        for reference in key_references(model):
            known.setdefault(reference.key, reference)
    return list(known.values())


def _keys(word: str) -> list[KeyReference]:
    """Keys that are called so: in full, else by their end, else by their symbol."""
    from rpscli.case.design import OLD_WORDS

    found, word = _formats(), OLD_WORDS.get(word, word)
    for called in (
        lambda key: key.key == word,
        lambda key: key.key.endswith(f".{word}"),
        lambda key: word in re.split(r"[\s=/,()]+", key.symbol or key.meaning.split(",")[0]),
    ):
        if hits := [key for key in found if called(key)]:
            return hits
    return []


def _options(word: str) -> Iterator[tuple[str, KeyReference]]:
    """Options of reports that are called so, each once, with the reports that have it."""
    from rpscli.case.schema.keys import key_references
    from rpscli.report.study.registry import REPORTS

    found: dict[KeyReference, list[str]] = {}
    for report in REPORTS:
        for key in key_references(REPORTS[report].options):
            if f".{key.key}".endswith(f".{word}"):
                found.setdefault(key, []).append(report)
    for key, reports in found.items():
        yield f"option {key.key} of the report{'s' * (len(reports) > 1)} {', '.join(reports)}", key


def glossary() -> list[tuple[str, str]]:
    """Words and meanings of the glossary."""
    text = resources.files("rpscli").joinpath("GLOSSARY.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (.+?) \| (.+) \|$", text, re.MULTILINE)
    return [(name.replace("`", ""), meaning) for name, meaning in rows if name != "word"]


def _names(entry: str) -> list[str]:
    return [part.strip().lower() for part in (entry, *re.split(r"[,()]", entry))]


def _tables(
    keys: Iterable[KeyReference],
    results: Iterable[ResultQuantity],
    words: Iterable[tuple[str, str]],
    reports: Iterable[tuple[str, str]],
    options: Iterable[tuple[str, KeyReference]],
) -> Iterator[Part]:
    alike: dict[tuple[object, ...], list[KeyReference]] = {}
    for key in keys:
        alike.setdefault(tuple(key._replace(key="")), []).append(key)
    for key, *others in alike.values():
        also = ", ".join(other.key for other in others[:2])
        more = f" and {len(others) - 2} more" if len(others) > 2 else ""
        yield Heading(key.key)
        if others:
            yield f"likewise {also}{more}"
        yield _lines(key)
        drawing = next((DRAWINGS[place] for place in DRAWINGS if key.key.startswith(place)), None)
        if drawing:
            yield drawing
    for quantity in results:
        yield Heading(f"{quantity.name}, a result")
        rows = {
            "means": quantity.label,
            "unit": quantity.unit or "none",
            "limit, as in": quantity.limit,
            "needs": quantity.needs,
            "is": quantity.meaning,
            "limits": "are at_least, since small values are bad" if quantity.from_below else "",
        }
        yield Table.listing(rows.items())
    named = [(f"{name}, a report of studies", meaning) for name, meaning in reports]
    for name, meaning in (*words, *named):
        yield Heading(name)
        yield meaning
    for title, option in options:
        yield Heading(title)
        yield _lines(option)


def _lines(key: KeyReference) -> Table:
    """What is known of a key."""
    from rpscli.report.study.registry import REPORTS

    needed = "none, required in its section" if key.required else ""
    names = f"{', '.join(REPORTS.names())}; `rps explain NAME` lists the options of one"
    rows = {
        "means": key.meaning,
        "symbol": key.symbol,
        "unit": "none" if key.unit == "-" else key.unit,
        "must be": key.bounds,
        "words": ", ".join(key.words),
        "names": names if key.key.split(".")[-1] == "reports" else "",
        "keys": ", ".join(key.keys),
        "default": needed if key.default is None else str(key.default),
        "enters": f"THEORY.md, section {key.sections}" if key.sections else "",
    }
    return Table.listing(rows.items())
