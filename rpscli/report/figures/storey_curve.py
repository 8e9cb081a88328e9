"""Restoring force of the storey against its displacement, as in Figure 1c of the paper."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rpscli.report.figures import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rpscli.analyses.pushover import PushoverResult


def storey_curve_figure(result: PushoverResult, title: str) -> bytes:
    """Force and lift of the cap beam against its displacement, to the critical rotation."""
    curve, beta = result.curve, result.structure.bearing.beta
    factor, prefix = style.engineering(float(np.max(curve.force)))
    rolling = curve.rotation <= beta

    def draw(figure: Figure) -> None:
        style.heading(figure, title, "storey of the bearings alone")
        force, lift = figure.subplots(2, 1, sharex=True, height_ratios=[2.6, 1.0])
        u, F, back = curve.displacement, factor * curve.force, factor * curve.unloading_force
        returns = bool(np.any(back != F))
        if returns:
            force.plot([], [], color=style.GREY, lw=1.5, ls="--", label="on the way back")
            force.axhline(0.0, color=style.GREY, lw=0.6)
        force.plot([0.0, 0.0], [0.0, F[0]], color=style.BLACK, lw=2.0, label="full contact")
        for inside, colour, name in (
            (rolling, style.BLUE, "rolling"),
            (~rolling | (curve.rotation == beta), style.RED, "rocking"),
        ):
            if np.count_nonzero(inside) > 1:
                force.plot(u[inside], F[inside], color=colour, lw=2.0, label=name)
                if returns:
                    force.plot(u[inside], back[inside], color=colour, lw=1.5, ls="--")
                lift.plot(u[inside], 1e3 * curve.lift[inside], color=colour, lw=2.0)
        _mark(force, 0.0, F[0], "uplift", (8.0, -4.0 if F[1] > F[0] else 6.0))
        if 0.0 < beta < result.critical_rotation:
            at = int(np.searchsorted(curve.rotation, beta))
            rises = F[at + 1] > F[at]
            side = (-7.0 if rises else 7.0, 6.0)
            _mark(force, u[at], F[at], f"$\\beta$ = {beta:.3f} rad", side)
        critical = f"$\\theta_{{cr}}$ = {result.critical_rotation:.3f} rad"
        _mark(force, u[-1], F[-1], critical, (-32.0, 4.0))
        _limits(force, u[-1], F.max(), min(0.0, back.min()) if returns else 0.0)
        force.set_ylabel(f"force at the cap beam [{prefix}N]")
        ratio = force.secondary_yaxis(
            "right", functions=style.over(factor * result.structure.uplift_force)
        )
        ratio.set_ylabel("$F/(W \\tan\\alpha)$ [-]")
        lift.set_ylim(bottom=0.0)
        lift.set_ylabel("lift [mm]")
        lift.set_xlabel("cap beam displacement $u_b$ [m]")
        style.legend_above(force, 3 + returns)
        figure.align_ylabels()

    return style.picture(draw, 4.8, 5.8)


def _mark(axes: Axes, x: float, y: float, text: str, offset: tuple[float, float]) -> None:
    """A point with its name, offset [pt] to the side on which no curve runs."""
    axes.plot(x, y, "o", color=style.BLACK, ms=5.0, zorder=5, clip_on=False)
    axes.annotate(
        text, (x, y), offset, textcoords="offset points", fontsize=style.small(),
        ha="left" if offset[0] > 0.0 else "right", va="bottom" if offset[1] > 0.0 else "top",
    )  # fmt: skip


def _limits(axes: Axes, end: float, top: float, bottom: float) -> None:
    axes.set_xlim(-0.02 * end, 1.04 * end)
    axes.set_ylim(1.1 * bottom, 1.18 * top)
