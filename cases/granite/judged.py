"""Choose the slenderness on half of the tests, and judge the model on the other half.

Run it as ``python judged.py results/granite/sweep`` after the study: `comparison_pairs.csv` has the
observed and computed outcome of every slenderness. Thresholds of PGA and PGV are chosen on the same
half, beyond which everything is taken to overturn; outcomes of the published discrete-element
models stand beside them.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

SHARE, SEED = 0.5, 1
RECORD, TITLE = "record [-]", "title [-]"
OBSERVED, COMPUTED = "observed [SI]", "computed [SI]"
SLENDERNESS = "podium.bearing.slenderness [-]"
MEASURES = {"PGV": "pgv [m/s]", "PGA": "pga [m/s2]"}


def _rows(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))


def worth(computed: Any, observed: Any) -> tuple[float, float, float]:
    """Share that disagrees, how far the count is off, and the standard error of the first."""
    misfit = float(np.mean(computed != observed))
    off = abs(float(computed.mean() - observed.mean()))
    return misfit, off, float(np.sqrt(misfit * (1.0 - misfit) / len(observed)))


def best(worths: list[tuple[float, float, float]]) -> int:
    """The best count among those that the misfit does not tell apart; of equals the middle."""
    # Up to one standard error above the least (Breiman et al., Classification and Regression
    # Trees, 1984): the least alone follows chance.
    least = min(worths)
    near = [each for each in worths if each[0] <= least[0] + least[2]]
    wanted = min(near, key=lambda each: (each[1], each[0]))
    places = [place for place, each in enumerate(worths) if each == wanted]
    return places[(len(places) - 1) // 2]


def threshold(intensity: Any, observed: Any) -> float:
    """Midway between two intensities, or the least or twice the largest of them."""
    levels = np.unique(intensity)
    cuts = np.array([levels[0], *np.sqrt(levels[1:] * levels[:-1]), 2.0 * levels[-1]])
    return float(cuts[best([worth(intensity >= cut, observed) for cut in cuts])])


def _flags(rows: list[dict[str, str]], name: str) -> Any:
    return np.array([float(row[name]) == 1.0 for row in rows])


def _ways(
    systems: dict[str, list[dict[str, str]]],
    points: list[dict[str, str]],
    fitted: set[str],
) -> Iterator[tuple[str, list[dict[str, str]], Any]]:
    """The model with the chosen slenderness, and thresholds: name, pairs, what overturns."""
    learnt = {
        choice: [r for r in rows if r[RECORD] in fitted]
        for choice, rows in systems.items()
    }
    worths = [
        worth(_flags(rows, COMPUTED), _flags(rows, OBSERVED)) for rows in learnt.values()
    ]
    choice = list(systems)[best(worths)]
    rows = systems[choice]
    yield f"model with tan(alpha) = {choice}", rows, _flags(rows, COMPUTED)
    for measure, name in MEASURES.items():
        known, at = (
            np.array([float(points[int(row["point [-]"]) - 1][name]) for row in of])
            for of in (learnt[choice], rows)
        )
        cut = threshold(known, _flags(learnt[choice], OBSERVED))
        yield f"threshold of {measure}, {cut:.3g}", rows, at >= cut


def lines(results: Path, published: Path) -> Iterator[str]:
    """Model, thresholds and published models of each specimen, on both halves."""
    pairs, points = _rows(results / "comparison_pairs.csv"), _rows(results / "points.csv")
    records = list(dict.fromkeys(row[RECORD] for row in pairs))
    drawn = np.random.default_rng(SEED).permutation(len(records))[
        : round(SHARE * len(records))
    ]
    fitted = {records[place] for place in drawn}
    for title in dict.fromkeys(row[TITLE] for row in pairs):
        systems: dict[str, list[dict[str, str]]] = {}
        for row in pairs:
            if row[TITLE] == title:
                systems.setdefault(row[SLENDERNESS], []).append(row)
        judged = [
            (f"{title}, {name}", *of) for name, *of in _ways(systems, points, fitted)
        ]
        by_record = {Path(row[RECORD]).stem: row for row in next(iter(systems.values()))}
        models: dict[str, list[dict[str, str]]] = {}
        for row in _rows(published):
            specimen = row["model"].split("-")[0].lower().strip()
            if specimen == title and row["record"] in by_record:
                models.setdefault(row["model"], []).append(row)
        judged += [
            (
                model,
                [by_record[row["record"]] for row in rows],
                _flags(rows, "overturned"),
            )
            for model, rows in sorted(models.items())
        ]
        for name, rows, fell in judged:
            seen, inside = (
                _flags(rows, OBSERVED),
                np.array([r[RECORD] in fitted for r in rows]),
            )
            for part, which in (("fitted", inside), ("held out", ~inside)):
                agreed, fallen = int((fell == seen)[which].sum()), int(fell[which].sum())
                counts = f"{agreed} of {which.sum()} agree, {fallen} overturned"
                yield f"{name}, {part}: {counts}"


if __name__ == "__main__":
    for line in lines(
        Path(sys.argv[1]), Path(__file__).resolve().parent / "published.csv"
    ):
        sys.stdout.write(f"{line}\n")
