"""Certified problems, which come as data, and the correct digits of any program's answers."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from rpscli.analyses.verification.known import Comparison
from rpscli.errors import CaseError, hint

FOLDER = Path(__file__).parents[1] / "certified"
ANSWERS = "answers.csv"
COLUMNS = ("problem", "quantity", "unit", "value")
Key = tuple[str, str]

ONE_PERCENT = 1.628
"""Kolmogorov's distance of two large samples of one distribution, over sqrt(1/n + 1/m)."""


def _rows(text: str, source: str) -> Iterator[tuple[int, Key, dict[str, str]]]:
    """Line, problem and quantity, and cells."""
    rows = csv.DictReader(io.StringIO(text), skipinitialspace=True, restval="")
    if lacking := {"problem", "quantity", "value"} - {*(rows.fieldnames or ())}:
        raise CaseError(
            f"{source}: line 1 names no column {min(lacking)}; begin with `{','.join(COLUMNS)}`"
        )
    for row in rows:
        yield rows.line_num, (row["problem"].strip(), row["quantity"].strip()), row


def certified() -> dict[Key, tuple[str, int, list[float]]]:
    """Of each quantity the unit, how many digits are certified, and its value or sample."""
    found: dict[Key, tuple[str, int, list[float]]] = {}
    for _, key, row in _rows((FOLDER / ANSWERS).read_text(encoding="utf-8"), ANSWERS):
        told = found.setdefault(key, (row["unit"], int(row["digits"]), []))
        told[2].append(float(row["value"]))
    return found


def problem_files() -> dict[str, bytes]:
    """Pages, cases and motions by their names, and the file of answers without values."""
    files = {path.name: path.read_bytes() for path in sorted(FOLDER.iterdir())}
    rows = [COLUMNS, *((*key, unit, "") for key, (unit, _, _) in certified().items())]
    return {**files, ANSWERS: "".join(f"{','.join(row)}\n" for row in rows).encode()}


def answers(text: str, source: str, digits: float) -> tuple[list[Comparison], list[str]]:
    """Answers of a CSV file, of which so many digits should be right; problems without any."""
    known, given = certified(), dict[Key, list[float]]()
    for line, key, row in _rows(text, source):
        place = f"{source}: line {line}"
        if key not in known:
            meant = hint(", ".join(key), map(", ".join, known), "the pages name what is")
            raise CaseError(f"{place}: {', '.join(key)} is not asked; {meant}")
        if written := row["value"].strip():
            try:
                number = float(written)
            except ValueError:
                number = math.nan
            if not math.isfinite(number):
                raise CaseError(f"{place}: the value {written[:40]!r} must be a finite number")
            given.setdefault(key, []).append(number)
    begun = {problem for problem, _ in given}
    found = [
        _answer(key, *told, given.get(key, []), digits)
        for key, told in known.items()
        if key[0] in begun
    ]
    return found, [*dict.fromkeys(problem for problem, _ in known if problem not in begun)]


def _answer(
    key: Key, unit: str, certain: int, values: list[float], given: list[float], digits: float
) -> Comparison:
    if certain:
        value, found = values[0], given[-1] if given else math.nan
        return Comparison(
            *key, unit, value, found, abs(value) * 10.0 ** -min(digits, certain), certain
        )
    distance = _distance(values, given) if given else math.nan
    limit = ONE_PERCENT * math.sqrt(1.0 / len(values) + 1.0 / max(len(given), 1))
    return Comparison(key[0], f"{key[1]}, distance of samples", "-", 0.0, distance, limit)


def _distance(*samples: list[float]) -> float:
    """Kolmogorov's, of two."""
    places = np.concatenate(samples)
    a, b = (np.searchsorted(np.sort(x), places, side="right") / len(x) for x in samples)
    return float(np.max(np.abs(a - b)))
