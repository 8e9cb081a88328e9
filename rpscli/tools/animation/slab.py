"""A slab that turns, seen from above: its outline, the heads of its columns, their feet."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.twist import TwistResult
from rpscli.report.figures import style
from rpscli.report.figures.twist import enlargement

Array = NDArray[np.float64]
MARGIN = 0.12
"""Of the plan's lengths, by which the slab is drawn beyond its columns."""


class SlabView:
    """The plan with ways enlarged; `show` moves it to a sample."""

    def __init__(self, axes: style.Axes, twist: TwistResult) -> None:
        self.twist = twist
        self.scale = enlargement(twist)
        places = twist.run.places
        half = (0.5 + MARGIN) * np.ptp(places, axis=0)
        self.corners = half * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
        axes.plot(*places.T, "+", color=style.GREY, ms=5.0)
        self.outline = axes.fill([], [], fc="none", ec=style.BLUE, lw=1.2)[0]
        self.heads = axes.plot([], [], "o", color=style.BLUE, ms=3.5)[0]
        self.worst = axes.plot([], [], "o", color=style.RED, ms=4.5)[0]
        reach = half.max() + self.scale * twist.max_corner_displacement
        axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
        axes.set(xlabel="x [m]", ylabel="y [m]")
        axes.locator_params(nbins=5)
        title = f"the slab from above, ways x {self.scale:.3g}"
        axes.set_title(title, fontsize=style.small())

    def show(self, sample: int) -> None:
        """Move slab and heads to where they are, enlarged, at a sample."""
        at = min(sample, len(self.twist.ways) - 1)
        heads = self.twist.run.places + self.scale * self.twist.column_ways[at]
        u_x, u_y, psi = self.twist.ways[at]
        moved = np.array([u_x, u_y]) + psi * self.corners[:, ::-1] * [-1.0, 1.0]
        self.outline.set_xy(self.corners + self.scale * moved)
        self.heads.set_data(*heads.T)
        self.worst.set_data(*heads[[self.twist.worst_column]].T)
