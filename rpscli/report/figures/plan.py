"""The plan of the columns, with the axial force of each when one has the largest."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.column_forces import PlanForces
from rpscli.model.podium import PodiumStructure
from rpscli.report.figures import style

Array = NDArray[np.float64]

MOST_NUMBERS = 49
"""Columns up to which each has its force written beside it."""
SHARE = 0.22
"""Width of a symbol over the least distance of rows."""


class ColumnPlan(NamedTuple):
    """Columns in plan and their axial forces at one instant."""

    structure: PodiumStructure
    forces: PlanForces

    @property
    def places(self) -> tuple[Array, Array]:
        """Rows in x and in y [m], these beside each other at even distances where the
        case does not give them.
        """
        rows = np.array(self.structure.rows, dtype=np.float64)
        if self.structure.rows_y:
            return rows, np.array(self.structure.rows_y, dtype=np.float64)
        across = max(1, round(self.structure.columns / len(rows)))
        least = float(np.min(np.diff(np.sort(rows))))
        return rows, np.arange(across, dtype=np.float64) * least

    @property
    def spread(self) -> Array:
        """(rows, rows in y) axial forces [N]: of one component columns beside each other
        carry alike.
        """
        x, y = self.places
        return np.broadcast_to(self.forces.forces, (len(x), len(y)))


def draw_plan(axes: style.Axes, plan: ColumnPlan) -> None:
    """Columns from above, the most loaded ones red, with their axial forces in kN."""
    x, y = plan.places
    forces = plan.spread
    gaps = np.concatenate([np.diff(np.sort(each)) for each in (x, y)])
    size = SHARE * float(np.min(gaps[gaps > 0.0]))
    largest = forces >= np.max(forces) * (1.0 - 1e-9)
    few = forces.size <= MOST_NUMBERS
    for (i, j), force in np.ndenumerate(forces):
        most = bool(largest[i, j])
        colour = style.RED if most else style.ORANGE if force < 0.0 else style.SKY
        column = plan.structure.column
        square = column is not None and column.section == "square"
        axes.add_patch(_symbol(float(x[i]), float(y[j]), size, colour, square=square))
        if few or most:
            text = f"{1e-3 * force:.4g}"
            look = {"weight": "bold"} if most else {}
            style.note(
                axes, text, (float(x[i]), float(y[j]) - 0.6 * size), (0.0, -1.0), **look
            )
    axes.plot([], [], "s", color=style.RED, label="largest axial force [kN]")
    if np.min(forces) < 0.0:
        axes.plot([], [], "s", color=style.ORANGE, label="would lift off")
    margin = 3.0 * size
    axes.set_xlim(np.min(x) - margin, np.max(x) + margin)
    axes.set_ylim(np.min(y) - margin, np.max(y) + margin)
    axes.set_aspect("equal")
    axes.set_xticks(x)
    axes.set_xlabel("$x$ [m]")
    if plan.structure.rows_y:
        axes.set_yticks(y)
        axes.set_ylabel("$y$ [m]")
    else:
        axes.set_yticks([])
        axes.set_ylabel("not given, drawn evenly")
    style.legend_above(axes)


def _symbol(x: float, y: float, size: float, colour: str, *, square: bool) -> Any:
    """A column of a square or a round section, not to scale."""
    from matplotlib.patches import Circle, Rectangle

    look: dict[str, Any] = {"fc": colour, "ec": style.BLACK, "lw": 0.7}
    if square:
        return Rectangle((x - 0.5 * size, y - 0.5 * size), size, size, **look)
    return Circle((x, y), 0.5 * size, **look)
