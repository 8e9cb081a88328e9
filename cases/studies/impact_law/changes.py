"""Map how results change with one key: median over the motions of ratios motion by motion.

Run it as ``python changes.py results/impact_law/sweep`` (or of `loss`) after the study; it reads
points.csv and draws changes.png: one map a result and kind of ends, overturning below.
"""

from __future__ import annotations

import csv
import sys
from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

STOREYS, PERIOD = "superstructure.storeys [-]", "superstructure.period [s]"
SLENDERNESS, MASSES = (
    "podium.bearing.slenderness [-]",
    "podium.superstructure_mass_ratio [-]",
)
ENDS = "podium.bearing.curvature_ratio [-]"
LAW, LOSS = "podium.impact.law [-]", "podium.impact.loss [-]"
RESULTS = {"rotation_ratio [-]": "rotation", "base_shear_ratio [-]": "base shear"}

Cell = tuple[str, ...]
Motion = tuple[bool, dict[str, float]]
"""Whether it overturned, and its results."""


def changes(pairs: Sequence[tuple[Motion, Motion]]) -> list[float]:
    """In per cent: medians of what stood under both, then the difference of the overturned."""
    found = []
    for name in RESULTS:
        ratios = [
            other[1][name] / one[1][name]
            for one, other in pairs
            if not one[0] and not other[0] and one[1][name] > 0.0
        ]
        found.append(100.0 * (float(np.median(ratios)) - 1.0) if ratios else np.nan)
    fallen = [sum(side[0] for side in sides) for sides in zip(*pairs, strict=True)]
    return [*found, 100.0 * (fallen[1] - fallen[0]) / len(pairs)]


def main(folder: Path) -> None:
    """Read, pair, draw."""
    with (folder / "points.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    key, values = (
        (LOSS, ("1.0", "0.4")) if LOSS in rows[0] else (LAW, ("flexible", "rigid"))
    )
    down, across = ((STOREYS,), (SLENDERNESS,))
    if key == LAW:
        down, across = ((STOREYS, PERIOD), (SLENDERNESS, MASSES))
    cells: dict[Cell, dict[str, list[Motion]]] = defaultdict(lambda: defaultdict(list))
    for row in rows:
        motion = (
            row["outcome [-]"].startswith("overturned"),
            {name: float(row[name] or "nan") for name in RESULTS},
        )
        cells[tuple(row[name] for name in (ENDS, *down, *across))][row[key]].append(
            motion
        )
    panels, lines, columns = (
        list(dict.fromkeys(cell[part] for cell in cells))
        for part in (slice(1), slice(1, 1 + len(down)), slice(1 + len(down), None))
    )
    maps = np.full((len(RESULTS) + 1, len(panels), len(lines), len(columns)), np.nan)
    for cell, by_value in cells.items():
        pairs = list(zip(*(by_value[value] for value in values), strict=True))
        place = (cell[:1], cell[1 : 1 + len(down)], cell[1 + len(down) :])
        at = panels.index(place[0]), lines.index(place[1]), columns.index(place[2])
        maps[:, *at] = changes(pairs)
    largest = float(np.nanmax(np.abs(maps)))
    figure = Figure(
        figsize=(8.0, 2.0 + 0.36 * len(lines) * len(maps)), layout="constrained"
    )
    grid = figure.subplots(
        len(maps), len(panels), squeeze=False, sharex=True, sharey=True
    )
    for (result, panel), axes in np.ndenumerate(grid):
        image = axes.imshow(
            maps[result, panel], cmap="RdBu_r", vmin=-largest, vmax=largest, aspect="auto"
        )
        axes.set_xticks(
            range(len(columns)), [", ".join(each) for each in columns], rotation=90
        )
        axes.set_yticks(range(len(lines)), [", ".join(each) for each in lines])
        if result == 0:
            axes.set_title(f"rho = {panels[panel][0]}")
        if panel == 0:
            axes.set_ylabel([*RESULTS.values(), "overturned, of 100"][result])
    figure.colorbar(image, ax=grid, label=f"change from {values[0]} to {values[1]} [%]")
    figure.savefig(folder / "changes.png", dpi=150)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
