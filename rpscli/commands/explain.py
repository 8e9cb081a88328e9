"""`rps explain`: meanings of keys, results, words, reports with
their options, and plugins.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from importlib import resources
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from rpscli.analyses.result_quantities import EVERY, ResultQuantity
from rpscli.commands.shell.options import completing, terminal_options
from rpscli.commands.shell.terminal import Terminal
from rpscli.errors import UsageError, hint
from rpscli.registry import Registry, summary_of
from rpscli.report.captions import CAPTIONS
from rpscli.report.files import heading
from rpscli.report.table import Heading, Part, Table

if TYPE_CHECKING:
    from rpscli.case.schema.keys import KeyReference
    from rpscli.registry import Offer

PLUGINS = "plugins"
"""The word for what other packages add."""
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


class ExplainEntry(NamedTuple):
    """A meaning: the list of the document in which it stands, what it
    says there, and its text.
    """

    kind: str
    said: dict[str, Any]
    parts: tuple[Part, ...] = ()


KINDS = ("keys", "results", "words", "reports", "options", "figures", "plugins")


def _known() -> list[str]:
    """All that may be asked for: keys, their ends, results, reports and words."""
    from rpscli.report.study.registry import REPORTS

    keys = [key.key for key in _formats()]
    names = [name for entry, _ in glossary() for name in _names(entry)]
    ends = [key.rsplit(".", 1)[-1] for key in keys]
    return list(dict.fromkeys([*keys, *ends, *EVERY, *REPORTS, *FIGURES, *names]))


@click.command("explain")
@click.argument("words", metavar="[KEY]", nargs=-1, **completing(_known))
@terminal_options
def command(words: tuple[str, ...], terminal: Terminal) -> None:
    """What KEY means: a key of cases or studies, a report, a result, a
    symbol, a word of tables.

    Keys are named in full (podium.bearing.slenderness), by their end (slenderness)
    or by their symbol (rho), words as they are printed (stays tilted). Without a KEY
    everything that has a meaning is listed. `plugins` lists what other packages add. `rps
    doctor` says where the guide is.
    """
    word = re.sub(r"\.\d+(?=\.|$)", "", " ".join(words))  # podium.devices.0.force
    if not word:
        terminal.result(*_everything())
        return
    report = [*_reports(word, everything=False, options=False)]
    meant = [
        _word(name, meaning, russian)
        for name, meaning, russian in glossary_rows()
        if _as_printed(word) in _names(name)
    ]
    # A row of a table may have two results: "uplifts, impacts".
    labels = {word.lower(), *(part.strip() for part in word.lower().split(","))}
    named = [
        q for q in EVERY.values() if word == q.name or (q.label in labels and not meant)
    ]
    figures = [_figure(word)] if word.removesuffix(".png") in FIGURES else []
    exact = [*report, *map(_result, named), *figures]
    keys = _keys(word, texts=not exact)
    entries = [*report, *keys, *map(_result, named), *figures, *meant]
    offers = [] if entries else list(_offers(word))
    if not report:
        alone = not (entries or offers)
        entries += _reports(word, everything=bool(offers), options=alone)
    if not (entries or offers or word == PLUGINS):
        instead = hint(
            word, _known(), "`rps explain podium` and the like list a section's keys"
        )
        raise UsageError(f"explain {word}: there is no such name; {instead}")
    parts = [part for entry in entries for part in entry.parts]
    parts += _listing(offers, everything=word == PLUGINS)
    entries += [ExplainEntry("plugins", offer._asdict()) for offer in offers]
    said = {
        kind: [entry.said for entry in entries if entry.kind == kind] for kind in KINDS
    }
    terminal.result({**heading("explain"), "word": word, **said}, parts)


def _listing(offers: list[Offer], *, everything: bool) -> Iterator[Part]:
    """Table of what other packages add; words if that is asked for and there is none."""
    heads = ("group", "name", "package", "is")
    rows = [(f"rpscli.{o.kind}", o.name, o.package, o.fault or o.meaning) for o in offers]
    if rows:
        yield Table.of_texts(heads, rows, words=len(heads))
    elif everything:
        yield (
            "no installed package adds anything; help(rpscli.plugins) explains how to"
            " write one"
        )


def _word(name: str, meaning: str, russian: str) -> ExplainEntry:
    """A word of the glossary."""
    said = {"word": name, "meaning": meaning, "russian": russian or None}
    parts = (Heading(name), meaning, *[f"in Russian: {russian}"] * bool(russian))
    return ExplainEntry("words", said, parts)


def glossary() -> list[tuple[str, str]]:
    """Words and meanings of the glossary."""
    return [(name, meaning) for name, meaning, _ in glossary_rows()]


def glossary_rows() -> list[tuple[str, str, str]]:
    """Words, meanings, and the Russian words where there are some."""
    text = resources.files("rpscli").joinpath("GLOSSARY.md").read_text(encoding="utf-8")
    cell = r"((?:[^|\n]|\|(?=\S))+?)"
    rows = re.findall(rf"^\| {cell} \| {cell}(?: \| {cell})? \|$", text, re.MULTILINE)
    return [
        (name.replace("`", ""), meaning, "" if russian == "-" else russian)
        for name, meaning, russian in rows
        if name != "word"
    ]


def _names(entry: str) -> list[str]:
    parts = (entry, *re.split(r"[,()]", entry))
    return [_as_printed(part) for part in parts]


def _as_printed(word: str) -> str:
    """A word as tables or as files have it: outcomes have spaces or strokes, and what
    follows a colon explains them.
    """
    return " ".join(word.partition(":")[0].replace("_", " ").lower().split())


def _everything() -> tuple[dict[str, Any], list[Part]]:
    """The names that have a meaning, kind by kind."""
    from rpscli.report.study.registry import REPORTS

    lists: dict[str, Iterable[str]] = {
        "sections of a case": dict.fromkeys(
            key.key.partition(".")[0] for key in _formats() if "." in key.key
        ),
        "results": EVERY,
        "reports of studies": REPORTS,
        "figures": FIGURES,
        "words": [name for name, _ in glossary()],
    }
    said = {kind: sorted(names, key=str.lower) for kind, names in lists.items()}
    parts: list[Part] = ["rps explain NAME, with one of these names:"]
    for kind, names in said.items():
        parts += [Heading(kind), ", ".join(names)]
    return {**heading("explain"), "word": None, "names": said}, parts


FIGURES = {name: text for name, text in CAPTIONS.items() if len(name) > 1}
"""Figures by the names of their files."""


def _figure(word: str) -> ExplainEntry:
    name = word.removesuffix(".png")
    said = {"figure": name, "shows": FIGURES[name]}
    return ExplainEntry("figures", said, (Heading(f"{name}, a figure"), FIGURES[name]))


def _result(quantity: ResultQuantity) -> ExplainEntry:
    text = Table.listing([
        ("means", quantity.label),
        ("unit", quantity.unit or "none"),
        ("limit, as in", quantity.limit),
        ("needs", quantity.needs),
        ("is", quantity.meaning),
        ("limits", "are at_least, since small values are bad" if quantity.from_below else ""),
    ])  # fmt: skip
    said = {name: value for name, value in quantity._asdict().items() if value}
    return ExplainEntry("results", said, (Heading(f"{quantity.name}, a result"), text))


def _formats() -> list[KeyReference]:
    """Every key of all kinds of files, once."""
    # pydantic is slow.
    from rpscli.case.schema.case_file import CaseFile
    from rpscli.case.schema.keys import key_references
    from rpscli.case.study.schema import StudyFile
    from rpscli.case.text.file_kinds import FILE_KINDS

    others = (kind.model for kind in FILE_KINDS.values())
    models = (CaseFile, StudyFile, *others)
    keys = [key for model in models for key in key_references(model)]
    return list({key.key: key for key in reversed(keys)}.values())[::-1]


def _keys(word: str, *, texts: bool) -> Iterator[ExplainEntry]:
    """Keys that are called so: in full, else by their end, else by their symbol, or by
    the first words of their meaning where texts count.
    """
    hits: list[KeyReference] = []
    for called in (
        lambda key: key.key == word,
        lambda key: key.key.endswith(f".{word}"),
        lambda key: texts and word in _first_words(key),
    ):
        hits = hits or [key for key in _formats() if called(key)]
    alike: dict[KeyReference, list[KeyReference]] = {}
    for key in hits:
        alike.setdefault(key._replace(key=""), []).append(key)
    for key, *others in alike.values():
        also = ", ".join(other.key for other in others[:2])
        more = f" and {len(others) - 2} more" if len(others) > 2 else ""
        likewise = [f"likewise {also}{more}"] if others else []
        drawing = [BEARING] if key.key.startswith("podium.bearing") else []
        yield ExplainEntry(
            "keys", _said(key), (Heading(key.key), *likewise, _lines(key), *drawing)
        )
        yield from (ExplainEntry("keys", _said(other)) for other in others)


def _first_words(key: KeyReference) -> list[str]:
    """Those of its symbol, or of its meaning up to a comma."""
    return re.split(r"[\s=/,()]+", key.symbol or key.meaning.split(",")[0])


def _said(key: KeyReference) -> dict[str, Any]:
    return {**key._asdict(), "keys": dict(key.keys)}


def _lines(key: KeyReference) -> Table:
    """All that is known of a key."""
    from rpscli.report.study.registry import REPORTS

    needed = "none, required in its section" if key.required else ""
    names = f"{', '.join(REPORTS.names())}; `rps explain NAME` lists the options of one"
    keys = zip(["keys", *[""] * len(key.keys)], map(": ".join, key.keys), strict=False)
    return Table.listing([
        ("means", key.meaning),
        ("symbol", key.symbol),
        ("unit", "none" if key.unit == "-" else key.unit),
        ("must be", key.bounds),
        ("words", ", ".join(key.words)),
        ("names", names if key.key.split(".")[-1] == "reports" else ""),
        ("default", needed if key.default is None else str(key.default)),
        ("enters", f"THEORY.md, section {key.sections}" if key.sections else ""),
        *keys,
    ])  # fmt: skip


def _reports(word: str, *, everything: bool, options: bool) -> Iterator[ExplainEntry]:
    """The report of this name with its options, of other packages
    only where all are wanted.

    Else the options of reports that are called so, each once, with
    the reports that have it.
    """
    from rpscli.case.schema.keys import key_references
    from rpscli.report.study.registry import REPORTS

    named: dict[KeyReference, list[str]] = {}
    if report := (REPORTS.everything() if everything else REPORTS).get(word):
        meaning = summary_of(report.options)
        text = Heading(f"{word}, a report of studies"), meaning
        yield ExplainEntry("reports", {"report": word, "meaning": meaning}, text)
        # Ranges of values of each limit are told at the limits of studies.
        keys = key_references(report.options)
        named = {key: [] for key in keys if not key.key.startswith("limits.")}
    for name in REPORTS if options and not report else ():
        for key in key_references(REPORTS[name].options):
            if f".{key.key}".endswith(f".{word}"):
                named.setdefault(key, []).append(name)
    for key, reports in named.items():
        of = (
            f" of the report{'s' * (len(reports) > 1)} {', '.join(reports)}"
            if reports
            else ""
        )
        yield ExplainEntry(
            "options", _said(key), (Heading(f"option {key.key}{of}"), _lines(key))
        )


def _offers(word: str) -> Iterator[Offer]:
    """Items of other packages: all for the word plugins, else those of that name."""
    from rpscli.commands.registry import others
    from rpscli.model.devices import DAMPERS
    from rpscli.model.impact import IMPACT_LAWS
    from rpscli.records.formats import FORMATS
    from rpscli.records.measures import MEASURES
    from rpscli.records.target import CODES
    from rpscli.report.figures.look import FIGURES
    from rpscli.report.study.registry import REPORTS

    kinds: tuple[Registry[Any], ...] = (
        FORMATS, MEASURES, CODES, REPORTS, FIGURES, DAMPERS, IMPACT_LAWS, others()
    )  # fmt: skip
    for registry in kinds:
        if word == PLUGINS or (word not in registry and word in registry.names()):
            yield from (
                each for each in registry.offers() if word in {PLUGINS, each.name}
            )
