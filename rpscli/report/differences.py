"""What differs between two results: inputs, versions, and each number with its noise beside it."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, NamedTuple

from rpscli.analyses.result_quantities import EVERY
from rpscli.report.table import Heading, Part, Table, headed, large, shown

MADE_ANEW = frozenset(
    ("files", "rps_version", "case", "verdicts", "passed", "exit_code", "command")
)
"""Keys of a document that are no results."""
BESIDE = frozenset(("neighbours", "warnings", "schema_version", "status", "note", "samples"))
"""Keys that are compared elsewhere, or not."""
NEAR = (0.99, 1.01)
"""Factors on the motion of the neighbours whose results are the noise of a history."""
HISTORIES = ("points.csv", "records.csv")
"""Tables with a history in each row."""
FIRST_RESULT = ("outcome [-]", "counted [-]", "admissible_share [-]")
"""Where results of a table begin; columns before them say what a row is about."""


def leaves(value: object, name: str = "") -> Iterator[tuple[str, Any]]:
    """Values of nested mappings and of lists of mappings under dotted names; other lists whole."""
    if isinstance(value, list) and any(isinstance(item, dict) for item in value):
        value = {str(index): item for index, item in enumerate(value)}
    if not isinstance(value, dict) or not value:
        yield name, value
        return
    for key, item in value.items():
        yield from leaves(item, f"{name}.{key}" if name else key)


def results_of(document: Mapping[str, Any]) -> dict[str, Any]:
    """The results of a document by dotted name."""
    return dict(leaves({key: document[key] for key in document if key not in MADE_ANEW}))


class Values(NamedTuple):
    """A result: one value, or those of a list or column by their labels, and its noise."""

    by: Mapping[str, Any]
    unit: str = ""
    noise: float | None = None


@dataclass
class Side:
    """One of the two that are compared."""

    source: str
    versions: Mapping[str, str | None]
    inputs: Mapping[str, Any]
    results: dict[str, Values] = field(default_factory=dict)
    warnings: Sequence[str] = ()

    def add_document(self, document: Mapping[str, Any]) -> None:
        """Take the results of a history, with those of the motions beside it."""
        self.warnings = document.get("warnings", ())
        near = [each for each in document.get("neighbours", ()) if each["factor"] in NEAR]
        for name, value in results_of(document).items():
            if name.partition(".")[0] in BESIDE:
                continue
            others = [{**each, **each.get("demands", {})}.get(name) for each in near]
            moved = [abs(x - value) for x in others if _is_number(x) and _is_number(value)]
            known = EVERY.get(name.rpartition(".")[2])
            unit = known.unit if known else "J" if name.startswith("energy.") else ""
            by = {str(i + 1): x for i, x in enumerate(value)} if isinstance(value, list) else None
            self.results[name] = Values(by or {"": value}, unit, max(moved, default=None))

    def add_table(self, name: str, text: str) -> None:
        """Take the columns of a CSV file."""
        heads, *rows = list(csv.reader(io.StringIO(text)))
        first = next((heads.index(head) for head in FIRST_RESULT if head in heads), 0)
        keys = [i for i, head in enumerate(heads[:first]) if head != "scale [-]"]
        labels: list[str] = []
        for row in rows:
            said = ", ".join(f"{heads[i].partition(' [')[0]} {row[i]}" for i in keys if row[i])
            again = f"row {len(labels) + 1}"
            labels.append(f"{said}, {again}" if said and said in labels else said or again)
        for i in (i for i in range(len(heads)) if i not in keys):
            self.results[f"{name}: {heads[i]}"] = Values(
                {label: _number(row[i]) for label, row in zip(labels, rows, strict=True)},
                heads[i].partition(" [")[2].rstrip("]"),
            )


def _number(cell: str) -> float | str | None:
    try:
        return float(cell)
    except ValueError:
        return cell or None


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and math.isfinite(value)


@dataclass(frozen=True)
class Difference:
    """A result that is not the same: where it differs most, and how much of the largest value.

    `relative` is None of words and of what one lacks. Of tables of histories `ratios` are median
    and fractiles of 16 and 84 % of B over A, and `relative` is how far that median is from 1, since
    single histories part ways whatever changes.
    """

    name: str
    unit: str
    at: str
    a: Any
    b: Any
    differing: int
    of: int
    largest: float | None = None
    relative: float | None = None
    noise: float | None = None
    ratios: tuple[float, ...] | None = None

    def exceeds(self, tolerance: float | None) -> bool:
        """Whether it counts."""
        return tolerance is not None and (self.relative is None or self.relative > tolerance)


def differences(a: Side, b: Side) -> list[Difference]:
    """Of all results that both have."""
    found = (_difference(name, of, b.results[name]) for name, of in a.results.items()
             if name in b.results)  # fmt: skip
    return [each for each in found if each is not None]


def _difference(name: str, a: Values, b: Values) -> Difference | None:
    pairs: dict[str, tuple[Any, Any]] = {
        at: (a.by.get(at), b.by.get(at)) for at in {**a.by, **b.by}
    }
    changed = {at: (x, y) for at, (x, y) in pairs.items() if x != y}
    if not changed:
        return None
    counted, noises = (len(changed), len(pairs)), [x for x in (a.noise, b.noise) if x is not None]
    if odd := {at: pair for at, pair in changed.items() if not all(map(_is_number, pair))}:
        at, (x, y) = next(iter(odd.items()))
        return Difference(name, a.unit, at, x, y, *counted)
    at, (x, y) = max(changed.items(), key=lambda each: abs(each[1][1] - each[1][0]))
    both = [pair for pair in pairs.values() if all(map(_is_number, pair))]
    largest = max(abs(value) for pair in both for value in pair)
    relative = abs(y - x) / largest
    ratios = None
    if name.startswith(HISTORIES) and (found := sorted(y / x for x, y in both if x)):
        ratios = tuple(found[round(part * (len(found) - 1))] for part in (0.5, 0.16, 0.84))
        relative = abs(ratios[0] - 1.0)
    noise = max(noises, default=None)
    return Difference(name, a.unit, at, x, y, *counted, largest, relative, noise, ratios)


def _changed(a: Mapping[str, Any], b: Mapping[str, Any]) -> list[tuple[str, Any, Any]]:
    """Names whose values differ, with both; None where there is none."""
    return [(n, a.get(n), b.get(n)) for n in {**a, **b} if a.get(n) != b.get(n)]


def as_text(value: object) -> str:
    """A value of a document for a table, cut where it is long."""
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) < 60 else f"{text[:57]}..."


def tables(
    a: Side, b: Side, found: Sequence[Difference], tolerance: float | None
) -> Iterator[Part]:
    """Inputs, versions and results that differ, and how much is the same."""
    yield Heading(f"A: {a.source}\nB: {b.source}")
    compared = {"inputs": (a.inputs, b.inputs), "versions": (a.versions, b.versions)}
    for title, of_both in compared.items():
        changed = [(n, as_text(x), as_text(y)) for n, x, y in _changed(*of_both)]
        names = (f"{title} that differ", "A", "B")
        yield Table.of_texts(names, changed, words=3) if changed else f"{title}: the same"
    if found:
        heads = ("result", "A", "B", "difference", "noise", "")
        yield Table.of_texts(heads, [_row(each, tolerance) for each in found])
    both = len(a.results.keys() & b.results.keys())
    yield f"{both - len(found)} of {both} results are the same to the last digit"
    for side, other in ((a, b), (b, a)):
        if only := [name for name in side.results if name not in other.results]:
            yield f"only {side.source} has {', '.join(only[:5])}{' ...' * (len(only) > 5)}"
    if any(each.noise is not None for each in found):
        yield (
            "noise: the largest change by 1 % less or more motion, in A or B; half the step"
            " changes rotation and shear by less than 0.01 %, or a warning says so"
        )
    if any(each.ratios for each in found):
        yield (
            "for tables with a history in each row the largest difference is shown; the median"
            " of B over A, with its 16 and 84 % fractiles, is what counts"
        )


def _row(each: Difference, tolerance: float | None) -> tuple[str, ...]:
    moved = "" if each.relative is None else f"{shown(100.0 * each.relative, 2)} %"
    noise = ""
    if each.ratios:
        noise = "{:.4f} ({:.4f} to {:.4f})".format(*each.ratios)
    elif each.noise is not None and each.largest and each.relative is not None:
        share = each.noise / each.largest
        noise = f"{'beyond' if each.relative > share else 'within'} {shown(100.0 * share, 2)} %"
    name = each.name if " [" in each.name else headed(each.name, each.unit)
    where = f", {each.at} ({each.differing} of {each.of})" if each.of > 1 else ""
    pair = (
        shown(large(value, each.unit)[0], 5) if _is_number(value) else as_text(value)
        for value in (each.a, each.b)
    )
    return name + where, *pair, moved, noise, "EXCEEDED" * each.exceeds(tolerance)


def comparison_document(a: Side, b: Side, found: Sequence[Difference]) -> dict[str, Any]:
    """The same in JSON: inputs and versions that differ, results with their noise."""
    compared = {"inputs": (a.inputs, b.inputs), "versions": (a.versions, b.versions)}
    return {
        "a": {"source": a.source, "versions": dict(a.versions), "warnings": list(a.warnings)},
        "b": {"source": b.source, "versions": dict(b.versions), "warnings": list(b.warnings)},
        **{
            name: [dict(zip(("name", "a", "b"), row, strict=True)) for row in _changed(*of_both)]
            for name, of_both in compared.items()
        },
        "compared": len(a.results.keys() & b.results.keys()),
        "results": [asdict(each) for each in found],
        "only_a": [name for name in a.results if name not in b.results],
        "only_b": [name for name in b.results if name not in a.results],
    }
