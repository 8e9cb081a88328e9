"""Outcomes of the published discrete-element models on the records that a comparison held out.

Run it as ``python published.py results/granite/sweep`` after the study.
"""

from __future__ import annotations

import csv
import sys
from collections import defaultdict
from pathlib import Path


def _rows(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))


def judged(results: Path, published: Path) -> list[tuple[str, str, int, int, int]]:
    """Of each model: its name, the part of the records, how many agree, are counted, overturned."""
    parts: dict[tuple[str, str], tuple[str, str]] = {}
    for row in _rows(results / "comparison_pairs.csv"):
        key = (row["title [-]"], Path(row["record [-]"]).stem)
        parts[key] = (row["records [-]"], row["observed [SI]"])
    found: dict[tuple[str, str], list[tuple[bool, bool]]] = defaultdict(list)
    for row in _rows(published):
        specimen = row["model"].split("-")[0].lower().strip()
        if (specimen, row["record"]) in parts:
            part, observed = parts[specimen, row["record"]]
            found[row["model"], part].append(
                (row["overturned"] == observed, row["overturned"] == "1")
            )
    return [
        (model, part, sum(a for a, _ in told), len(told), sum(o for _, o in told))
        for (model, part), told in sorted(found.items())
    ]


if __name__ == "__main__":
    for line in judged(Path(sys.argv[1]), Path(__file__).resolve().parent / "published.csv"):
        print("{}, {}: {} of {} agree, {} overturned".format(*line))
