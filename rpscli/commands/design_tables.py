"""The answer of a search as tables for a terminal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from rpscli.case.conditions import condition_text
from rpscli.report.documents import ONE_DIRECTION
from rpscli.report.numbers import large, measured, shown
from rpscli.report.table import Heading, Part, Table

if TYPE_CHECKING:
    from rpscli.sweep.design.answer import Answer
    from rpscli.sweep.statistics.verdicts import Verdict

DIGITS = 4
RECORDS_SHOWN = 3


def answer_tables(
    document: dict[str, Any],
    answer: Answer,
    confirmation: Mapping[str, Sequence[Verdict]],
) -> Iterator[Part]:
    """Best design, requirements, what the records do to it, and what confirms which design."""
    from rpscli.report.study.statistics import verdict_text

    counts = document["designs"]
    best = document["best"]
    yield Heading(document["study"]["title"])
    yield Table.listing([(name.replace("_", " "), str(count)) for name, count in counts.items()])
    yield _values(document, best or document["closest"], "best" if best else "fails least")
    yield _requirements(document, answer)
    if best is not None:
        yield Table.listing(list(_records(document)))
    if len(answer.front):
        yield f"front of both aims: {len(answer.front)} designs, in front.csv"
    if confirmation:
        yield Heading(f"confirmation with {len(answer.task.confirming)} records that were not used")
        rows = [
            (
                design,
                verdict.condition.name,
                "EXCEEDED" if verdict.exceeded else "met",
                condition_text(verdict.condition),
                verdict_text(verdict),
            )
            for design, verdicts in confirmation.items()
            for verdict in verdicts
        ]
        yield Table.of_texts(("design", "limit", "", "asked for", "found"), rows, words=5, keys=2)
    yield ONE_DIRECTION


def _values(document: dict[str, Any], design: dict[str, Any], head: str) -> Table:
    from rpscli.report.study.labels import symbol
    from rpscli.sweep.intensities import unit_of

    intervals = document["records"]["intervals"]
    ends = {item["key"]: item["end"] for item in document["at_bounds"]}
    rows = []
    for key, value in design["values"].items():
        unit = unit_of(key)
        name = symbol(key) if unit == "-" else f"{symbol(key)} [{unit}]"
        least = "least" if symbol(key) in design["aims"] else ""
        end = f"{ends[key]} of its range" if key in ends else least
        rows.append((name, end, shown(value, DIGITS), _interval(intervals[key])))
    for aim, value in _further_aims(document, design):
        name, interval = aim["aim"], intervals.get(aim["aim"], ())
        limits = [large(end, aim["unit"])[0] or 0.0 for end in interval]
        number, unit = large(value, aim["unit"])
        rows.append(
            (
                f"{name} [{unit}]" if unit else name,
                "least",
                shown(number, DIGITS),
                _interval(limits),
            )
        )
    return Table.of_texts(("", "", head, "95 % of resamples"), rows, words=2)


def _further_aims(
    document: dict[str, Any], design: dict[str, Any]
) -> Iterator[tuple[dict[str, str], float]]:
    """What is to be least and is not itself one of the values of a design."""
    from rpscli.report.study.labels import symbol

    names = {symbol(key) for key in design["values"]}
    for aim, value in zip(document["least"], design["aims"].values(), strict=True):
        if aim["aim"] not in names:
            yield aim, value


def _interval(interval: Iterable[float]) -> str:
    known = [end for end in interval if end == end]  # noqa: PLR0124 -- not NaN
    return " to ".join(shown(end, 3) for end in known) or "-"


def _requirements(document: dict[str, Any], answer: Answer) -> Table:
    rows = []
    for row, requirement in zip(document["requirements"], answer.judged.requirements, strict=True):
        if row["binds"]:
            unit = document["least"][0]["unit"]
            remark = f"binds; without it {measured(row['aim_without_it'], unit)}"
        else:
            remark = "" if row["met"] else "NOT MET"
        rows.append(
            (
                row["requirement"],
                condition_text(requirement.condition),
                remark,
                shown(row["value"], DIGITS),
                f"{row['designs_that_meet_it']} designs",
            )
        )
    heads = ("requirement", "asked for", "", "found", "met by")
    return Table.of_texts(heads, rows, words=3)


def _records(document: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """How sharp the answer is, and how it hangs on the choice of records."""
    from rpscli.report.study.labels import label
    from rpscli.sweep.design.answer import ROBUST
    from rpscli.sweep.intensities import unit_of

    records = document["records"]
    for end, word in zip(document["bracket"] or (), ("smaller", "larger"), strict=False):
        if end is not None:
            (key,) = document["best"]["values"]
            unit = unit_of(key).removesuffix("-")
            yield f"the next {word} value that fails", f"{shown(end, 6)} {unit}".rstrip()
    if not records["resamples"]:
        return
    share = 100.0 * records["passing_share_of_best"]
    yield "the best design passes in", f"{share:.0f} % of {records['resamples']} resamples"
    if (robust := document["robust"]) is not None:
        found = [
            label(key, float(shown(value, DIGITS)) if isinstance(value, float) else value)
            for key, value in robust["values"].items()
        ]
        aims = _further_aims(document, robust)
        found += [f"{aim['aim']} {measured(value, aim['unit'])}" for aim, value in aims]
        yield f"the best in {100.0 * ROBUST:g} % of them", ", ".join(found)
    if records["without_answer"]:
        yield "nothing passes in", f"{records['without_answer']} of them"
    aim, unit = document["least"][0].values()
    least = document["best"]["aims"][aim]
    changes = [
        (abs(value - least), item["record"], value)
        for item in records["without_one"]
        if item["best"] is not None and (value := item["best"]["aims"][aim]) != least
    ]
    for _, record, value in sorted(changes, reverse=True)[:RECORDS_SHOWN]:
        yield f"without {record}", f"{aim} {measured(value, unit)}"


def nothing_passes(answer: Answer) -> str:
    """Which requirement stands in the way least, if no design passes; else nothing."""
    from rpscli.report.design.answer import requirement_label
    from rpscli.sweep.design.answer import NONE

    if answer.best != NONE:
        return ""
    judged, place = answer.judged, answer.closest
    rows = [row for row in range(len(judged.requirements)) if not judged.met[row, 0, place]]
    lines = [f"no design of {len(answer.places)} meets all requirements"]
    for row in sorted(rows, key=lambda row: float(judged.excess[row, place])):
        requirement = judged.requirements[row]
        value = shown(float(judged.values[row, 0, place]), DIGITS)
        lines.append(
            f"{requirement_label(requirement)}: {condition_text(requirement.condition)}; {value} in"
            f" the design that fails least, {100.0 * judged.excess[row, place]:.3g} % of the"
            f" records too many; {int(judged.met[row, 0].sum())} designs meet it"
        )
    return "\n".join(lines)
